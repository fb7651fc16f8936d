// Definitions of atomic_file.hpp.
#pragma once

#include <palpate/core/detail/atomic_file.hpp>
#include <palpate/core/detail/content_hash.hpp>
#include <palpate/core/platform.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
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

PALPATE_INLINE AtomicFile::~AtomicFile() {
  if (open_) discard();
}

PALPATE_INLINE bool AtomicFile::commit() {
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

PALPATE_INLINE void AtomicFile::discard() noexcept {
  file_.reset();
  std::remove(temporary_.c_str());
}

PALPATE_INLINE std::string AtomicFile::unique_digits() {
  static std::atomic<std::uint64_t> calls{0};
  ContentHash hash;
  hash.add(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
  hash.add(static_cast<std::uint64_t>(std::hash<std::thread::id>()(std::this_thread::get_id())));
  hash.add(calls.fetch_add(1));
  std::array<char, digits + 1> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash.digest()));
  return text.data();
}

PALPATE_INLINE bool AtomicFile::is_leftover(const std::filesystem::path& file) const {
  using Name = std::filesystem::path::string_type;  // a name on Windows need not exist as std::string
  const Name name = file.filename().native(), hexadecimal = std::filesystem::path("0123456789abcdef").native();
  const Name start = std::filesystem::path(path_ + suffix).filename().native();
  if (name.size() != start.size() + digits || !name.starts_with(start)) return false;
  return name.find_first_not_of(hexadecimal, start.size()) == Name::npos;
}

PALPATE_INLINE void AtomicFile::remove_leftovers() const {
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

}}  // namespace palpate
