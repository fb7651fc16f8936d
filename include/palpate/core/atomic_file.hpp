// A file that appears complete or not at all.
#pragma once

#include <palpate/core/binary_io.hpp>
#include <palpate/core/platform.hpp>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

/// Writes under a name nobody else uses, `<path>.tmp-<16 hexadecimal digits>`, and renames at the end, which replaces
/// an older file at once: who opens `path` finds the old file or the new one, and of several writers the last one
/// stays. The destructor removes what was not renamed. Nothing is forced to the disk: after a power failure the file
/// may be damaged, which its reader must find out. Nothing throws but memory.
class AtomicFile {
 public:
  /// Opens; `stream()` is null and `error()` says why when that failed. Files of this pattern that a killed process
  /// left behind are removed when they are older than an hour.
  explicit AtomicFile(std::string path) : path_(std::move(path)) {
    remove_leftovers();
    for (int attempt = 0; attempt < 16 && !file_; ++attempt) {
      temporary_ = path_ + suffix + unique_digits();
      errno = 0;
      file_.reset(platform::create_new_file(temporary_));
      const int code = errno;
      if (!file_) error_ = detail::system_message(code);
      if (code != EEXIST) break;
    }
    open_ = file_ != nullptr;
  }
  ~AtomicFile() {
    if (open_) discard();
  }
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::FILE* stream() const noexcept { return file_.get(); }
  const std::string& error() const noexcept { return error_; }

  /// Closes and renames; false when the disk was full or the name could not be taken.
  bool commit() {
    errno = 0;
    if (std::fclose(file_.release()) != 0) {
      error_ = detail::system_message(errno);
      return false;
    }
    std::error_code problem;
    std::filesystem::rename(temporary_, path_, problem);  // unlike std::rename also replaces on Windows
    if (problem) error_ = problem.message();
    open_ = static_cast<bool>(problem);
    return !problem;
  }

 private:
  static constexpr const char* suffix = ".tmp-";
  static constexpr std::size_t digits = 16;

  void discard() noexcept {
    file_.reset();
    std::remove(temporary_.c_str());
  }

  /// Differs between threads, processes and calls; if not, opening says so.
  static std::string unique_digits() {
    static std::atomic<std::uint64_t> calls{0};
    ContentHash hash;
    hash.add(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
    hash.add(static_cast<std::uint64_t>(std::hash<std::thread::id>()(std::this_thread::get_id())));
    hash.add(calls.fetch_add(1));
    std::array<char, digits + 1> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash.digest()));
    return text.data();
  }

  bool is_leftover(const std::filesystem::path& file) const {
    using Name = std::filesystem::path::string_type;  // a name on Windows need not exist as std::string
    const Name name = file.filename().native(), hexadecimal = std::filesystem::path("0123456789abcdef").native();
    const Name start = std::filesystem::path(path_ + suffix).filename().native();
    if (name.size() != start.size() + digits || !name.starts_with(start)) return false;
    return name.find_first_not_of(hexadecimal, start.size()) == Name::npos;
  }

  void remove_leftovers() const {
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

  std::string path_, temporary_, error_;
  detail::File file_;
  bool open_ = false;  // there is a temporary file
};

}}  // namespace palpate
