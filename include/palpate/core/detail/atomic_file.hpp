// A file that appears complete or not at all.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/binary_io.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// Writes under a unique name, `<path>.tmp-<16 hexadecimal digits>`, and renames at the end, which replaces an older
/// file atomically: a reader of `path` finds either the old file or the new one, and of several writers the last one
/// wins. The destructor removes a file that was not renamed. The data is not flushed to disk: after a power failure the
/// file may be damaged, and its reader must detect that. Throws only std::bad_alloc.
class AtomicFile {
 public:
  /// Opens the temporary file. On failure `stream()` is null and `error()` gives the reason. Files of this name pattern
  /// that a killed process left behind are removed if they are older than an hour.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::FILE* stream() const noexcept { return file_.get(); }
  const std::string& error() const noexcept { return error_; }

  /// Closes and renames; false if the disk was full or the rename failed.
  bool commit();

 private:
  static constexpr const char* suffix = ".tmp-";
  static constexpr std::size_t digits = 16;

  void discard() noexcept;

  /// Differs between threads, processes and calls; in case of a collision, opening fails with EEXIST.
  static std::string unique_digits();

  bool is_leftover(const std::filesystem::path& file) const;

  void remove_leftovers() const;

  std::string path_, temporary_, error_;
  detail::File file_;
  bool open_ = false;  // there is a temporary file
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/core/detail/atomic_file.ipp>
#endif
