// A time series of files for ParaView.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/message.hpp>
#include <palpate/io/vtu.hpp>

#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A PVD file: a time series of VTU files that ParaView opens and plays as one. The file on disk is complete after
/// every call.
class PvdSeries {
 public:
  /// Begins the series, replacing a file of that name. Throws bad_file if it cannot be written.
  explicit PvdSeries(const std::string& path);

  /// Adds a file at a time [s]. `file` is written relative to the folder of the series, so that the two can be moved
  /// together. Throws non_finite for a time that is not finite, and bad_file if writing fails. O(1).
  void add(double time, const std::string& file);

  Index size() const noexcept { return size_; }  ///< number of files added

 private:
  /// Overwrites the closing tags with `text`, then writes them again.
  void put(const std::string& text);

  struct Close {
    void operator()(std::FILE* stream) const noexcept { std::fclose(stream); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::fpos_t end_{};  ///< where the closing tags begin
  Index size_ = 0;
};

inline PvdSeries::PvdSeries(const std::string& path) : path_(path), stream_(std::fopen(path.c_str(), "wb")) {
  if (!stream_) refuse(SetupErrorKind::bad_file, {path_, ": cannot be opened for writing"});
  std::fgetpos(stream_.get(), &end_);
  put(joined({"<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"",
              std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", "\">\n  <Collection>\n"}));
}

inline void PvdSeries::add(double time, const std::string& file) {
  if (!std::isfinite(time)) refuse(SetupErrorKind::non_finite, {"the time of '", file, "' is not finite"});
  const auto folder = std::filesystem::path(path_).parent_path();
  const std::string entry = std::filesystem::path(file).lexically_proximate(folder).generic_string();
  put(joined({"    <DataSet timestep=\"", to_decimal(time), "\" part=\"0\" file=\"", vtk::escape(entry), "\"/>\n"}));
  ++size_;
}

inline void PvdSeries::put(const std::string& text) {
  std::FILE* stream = stream_.get();
  constexpr std::string_view closing = "  </Collection>\n</VTKFile>\n";
  const bool is_written =
      std::fsetpos(stream, &end_) == 0 && std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
      std::fgetpos(stream, &end_) == 0 && std::fwrite(closing.data(), 1, closing.size(), stream) == closing.size() &&
      std::fflush(stream) == 0;
  if (!is_written) refuse(SetupErrorKind::bad_file, {path_, ": writing failed"});
}

}}}  // namespace palpate::PALPATE_ABI::io
