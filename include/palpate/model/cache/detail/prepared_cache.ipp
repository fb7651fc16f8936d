// Definitions of prepared_cache.hpp.
#pragma once

#include <palpate/model/cache/detail/prepared_cache.hpp>
#include <palpate/core/detail/atomic_file.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <cerrno>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::uint64_t CacheHeader::right_hash() const noexcept {
  CacheHeader all_but_hash = *this;
  all_but_hash.hash = 0;
  ContentHash h;
  h.add(all_but_hash);
  return h.digest();
}

PALPATE_INLINE CacheMismatch read_cache_header(std::FILE* file, CacheHeader& header, std::string& why) {
  std::array<char, sizeof(CacheHeader)> bytes{};
  const std::size_t size = std::fread(bytes.data(), 1, bytes.size(), file);
  const std::size_t compared = std::min(size, CacheHeader::our_magic.size());
  if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(compared), CacheHeader::our_magic.begin()))
    return why = "it is not a cache file of palpate", CacheMismatch::foreign;
  if (size < bytes.size()) return why = "it is truncated", CacheMismatch::truncated;
  std::memcpy(&header, bytes.data(), bytes.size());
  if (header.byte_order != CacheHeader::our_byte_order)
    return why = "its byte order differs", CacheMismatch::byte_order;
  const auto versions = [&](const char* of, std::uint64_t file_version, std::uint64_t here) {
    why = "its version differs (" + std::string(of) + ' ' + std::to_string(file_version) + " in the file, " +
          std::to_string(here) + " here)";
    return CacheMismatch::version;
  };
  if (header.layout != CacheHeader::our_layout) return versions("layout", header.layout, CacheHeader::our_layout);
  if (header.version != CacheHeader().version) return versions("library", header.version, CacheHeader().version);
  if (header.hash != header.right_hash()) return why = "its header is damaged", CacheMismatch::header;
  return CacheMismatch::none;
}

PALPATE_INLINE PreparedCache::PreparedCache(std::string file, const CacheKey& key, CacheReport& report)
    : key_(key), report_(&report) {
  report.file = std::move(file);
}

PALPATE_INLINE bool PreparedCache::open() {
  namespace fs = std::filesystem;
  std::error_code problem;
  const fs::file_status status = fs::status(report_->file, problem);
  if (status.type() == fs::file_type::not_found) return false;
  if (status.type() == fs::file_type::none)
    return reject(CacheMismatch::unreadable, "it cannot be read: " + problem.message());
  // Opening a pipe would block for ever, and a device must not be replaced.
  if (!fs::is_regular_file(status)) return reject(CacheMismatch::foreign, "it is not a regular file");
  errno = 0;
  file_.reset(std::fopen(report_->file.c_str(), "rb"));
  if (!file_) return reject(CacheMismatch::unreadable, "it cannot be read: " + detail::system_message(errno));
  CacheHeader header;
  std::string why;
  CacheMismatch mismatch = read_cache_header(file_.get(), header, why);
  if (mismatch == CacheMismatch::none) mismatch = compare(header.key, key_, why);
  if (mismatch != CacheMismatch::none) return reject(mismatch, std::move(why));
  reader_.emplace(file_.get());
  return true;
}

PALPATE_INLINE bool PreparedCache::verify() {
  const std::uint64_t right = reader_->digest();
  std::uint64_t stored = 0;
  if (reader_->good()) reader_->value(stored);
  if (reader_->failure() == ReadFailure::ended) return reject(CacheMismatch::truncated, "it is truncated");
  if (reader_->failure() == ReadFailure::unfit)
    return reject(CacheMismatch::elimination, "the order of elimination differs: other code or compiler flags");
  if (!reader_->good() || stored != right || std::fgetc(file_.get()) != EOF)
    return reject(CacheMismatch::payload, "its payload is damaged");
  report_->bytes = sizeof(CacheHeader) + static_cast<std::size_t>(reader_->bytes_read());
  file_.reset();
  return report_->read = true;
}

PALPATE_INLINE bool PreparedCache::reject(CacheMismatch mismatch, std::string why) {
  file_.reset();
  report_->read = false;
  report_->mismatch = mismatch;
  report_->why = std::move(why);
  return false;
}

PALPATE_INLINE void PreparedCache::store(const std::function<void(BinaryWriter&)>& write) {
  if (report_->mismatch == CacheMismatch::foreign) {  // for example a mesh, given by mistake
    report_->problem = report_->why + " and was left alone: remove it or give another name";
    return;
  }
  AtomicFile file(report_->file);
  if (file.stream() == nullptr) return fail(file.error());
  CacheHeader header{.key = key_};
  header.hash = header.right_hash();
  errno = 0;
  if (std::fwrite(&header, sizeof header, 1, file.stream()) != 1) return fail(detail::system_message(errno));
  BinaryWriter out(file.stream());
  write(out);
  out.value(out.digest());
  if (!out.good()) return fail(detail::system_message(out.error()));
  if (!file.commit()) return fail(file.error());
  report_->written = true;
  report_->bytes = sizeof header + static_cast<std::size_t>(out.written());
}

}}  // namespace palpate
