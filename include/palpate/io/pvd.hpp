// A time series of files for ParaView.
#pragma once

#include <palpate/io/vtu.hpp>

#include <cstdio>
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

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/pvd.ipp>
#endif
