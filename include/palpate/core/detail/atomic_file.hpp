// A file that appears complete or not at all.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/core/detail/content_hash.hpp>
#include <palpate/core/platform.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Writes under a unique name, `<path>.tmp-<16 hexadecimal digits>`, and renames at the end, which replaces an older
/// file atomically: a reader of `path` finds either the old file or the new one, and of several writers the last one
/// wins. The destructor removes a file that was not renamed. The data is not flushed to disk: after a power failure the
/// file may be damaged, and its reader must detect that. Throws only std::bad_alloc.
class AtomicFile {
 public:
  /// Opens the temporary file. On failure `stream()` is null and `error()` gives the reason. Files of this name pattern
  /// that a killed process left behind are removed if they are older than an hour.
  explicit AtomicFile(std::string path);
  ~AtomicFile() {
    if (open_) discard();
  }
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
  File file_;
  bool open_ = false;  // there is a temporary file
};

inline AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  remove_leftovers();
  for (int attempt = 0; attempt < 16 && !file_; ++attempt) {
    temporary_ = path_ + suffix + unique_digits();
    errno = 0;
    file_.reset(platform::create_new_file(temporary_));
    const int code = errno;
    if (!file_) error_ = system_message(code);
    if (code != EEXIST) break;
  }
  open_ = file_ != nullptr;
}

inline bool AtomicFile::commit() {
  errno = 0;
  if (std::fclose(file_.release()) != 0) {
    error_ = system_message(errno);
    return false;
  }
  std::error_code problem;
  std::filesystem::rename(temporary_, path_, problem);  // unlike std::rename also replaces on Windows
  if (problem) error_ = problem.message();
  open_ = static_cast<bool>(problem);
  return !problem;
}

inline void AtomicFile::discard() noexcept {
  file_.reset();
  std::remove(temporary_.c_str());
}

inline std::string AtomicFile::unique_digits() {
  static std::atomic<std::uint64_t> calls{0};
  ContentHash hash;
  hash.add(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
  hash.add(static_cast<std::uint64_t>(std::hash<std::thread::id>()(std::this_thread::get_id())));
  hash.add(calls.fetch_add(1));
  std::array<char, digits + 1> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash.digest()));
  return text.data();
}

inline bool AtomicFile::is_leftover(const std::filesystem::path& file) const {
  using Name = std::filesystem::path::string_type;  // a name on Windows need not exist as std::string
  const Name name = file.filename().native(), hexadecimal = std::filesystem::path("0123456789abcdef").native();
  const Name start = std::filesystem::path(path_ + suffix).filename().native();
  if (name.size() != start.size() + digits || !name.starts_with(start)) return false;
  return name.find_first_not_of(hexadecimal, start.size()) == Name::npos;
}

inline void AtomicFile::remove_leftovers() const {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::path(path_).parent_path();
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (fs::directory_iterator it(folder.empty() ? fs::path(".") : folder, ignored), end; !ignored && it != end;
       it.increment(ignored)) {
    if (!is_leftover(it->path())) continue;
    std::error_code unknown;
    if (const auto written = fs::last_write_time(it->path(), unknown); !unknown && written < old)
      fs::remove(it->path(), unknown);
  }
}

}}}  // namespace palpate::detail
