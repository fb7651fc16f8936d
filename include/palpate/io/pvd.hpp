// A list of files at points in time, for ParaView.
#pragma once

#include <palpate/io/vtu.hpp>

#include <cstdio>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A PVD file: a time series of VTU files that ParaView opens and plays as one. The file on disk is complete after
/// every call.
class PvdSeries {
 public:
  /// Begins the series, replacing a file of that name. Throws bad_file when it cannot be written.
  explicit PvdSeries(const std::string& path);

  /// Adds a file at a time [s]. `file` is written relative to the folder of the series, so the two can be moved
  /// together. Throws non_finite for the time and bad_file when writing fails. Constant cost.
  void add(double time, const std::string& file);

  Index size() const noexcept { return size_; }  ///< number of files added

 private:
  /// Writes `text` over the closing tags, then these again.
  void put(const std::string& text);

  struct Close {
    void operator()(std::FILE* stream) const noexcept { std::fclose(stream); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::fpos_t end_{};  ///< where the closing tags begin
  Index size_ = 0;
};

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/pvd.ipp>
#endif
