// A list of files at points in time, for ParaView.
#pragma once

#include <palpate/io/vtu.hpp>

#include <filesystem>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A PVD file: a time series of VTU files that ParaView opens and plays as one. The file on disk is complete after
/// every call.
class PvdSeries {
 public:
  /// Begins the series, replacing a file of that name. Throws bad_file when it cannot be written.
  explicit PvdSeries(const std::string& path) : path_(path), stream_(path, std::ios::binary | std::ios::trunc) {
    if (!stream_) raise(SetupErrorKind::bad_file, path_ + ": cannot be opened for writing");
    const std::string endian = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    put("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"" + endian +
        "\">\n  <Collection>\n");
  }

  /// Adds a file at a time [s]. `file` is written relative to the folder of the series, so the two can be moved
  /// together. Throws non_finite for the time and bad_file when writing fails. Constant cost.
  void add(double time, const std::string& file) {
    if (!std::isfinite(time)) raise(SetupErrorKind::non_finite, "the time of '" + file + "' is not finite");
    const auto folder = std::filesystem::path(path_).parent_path();
    const std::string entry = std::filesystem::path(file).lexically_proximate(folder).generic_string();
    put("    <DataSet timestep=\"" + to_decimal(time) + "\" part=\"0\" file=\"" + vtk::escape(entry) + "\"/>\n");
    ++size_;
  }

  Index size() const noexcept { return size_; }  ///< number of files added

 private:
  /// Writes `text` over the closing tags, then these again.
  void put(const std::string& text) {
    stream_.seekp(end_);
    stream_ << text;
    end_ = stream_.tellp();
    stream_ << "  </Collection>\n</VTKFile>\n" << std::flush;
    if (!stream_) raise(SetupErrorKind::bad_file, path_ + ": writing failed");
  }

  std::string path_;
  std::ofstream stream_;
  std::streamoff end_ = 0;
  Index size_ = 0;
};

}}}  // namespace palpate::io
