// A file that appears complete or not at all.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/binary_io.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// Writes under a name nobody else uses, `<path>.tmp-<16 hexadecimal digits>`, and renames at the end, which replaces
/// an older file at once: who opens `path` finds the old file or the new one, and of several writers the last one
/// stays. The destructor removes what was not renamed. Nothing is forced to the disk: after a power failure the file
/// may be damaged, which its reader must find out. Nothing throws but memory.
class AtomicFile {
 public:
  /// Opens; `stream()` is null and `error()` says why when that failed. Files of this pattern that a killed process
  /// left behind are removed when they are older than an hour.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::FILE* stream() const noexcept { return file_.get(); }
  const std::string& error() const noexcept { return error_; }

  /// Closes and renames; false when the disk was full or the name could not be taken.
  bool commit();

 private:
  static constexpr const char* suffix = ".tmp-";
  static constexpr std::size_t digits = 16;

  void discard() noexcept;

  /// Differs between threads, processes and calls; if not, opening says so.
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
