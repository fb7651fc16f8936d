// The cache file of a prepared model: header, numbers, hash.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/atomic_file.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/core/detail/content_hash.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/model/cache/cache_report.hpp>
#include <palpate/model/cache/detail/cache_key.hpp>
#include <palpate/version.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The first bytes of a cache file, in the byte order of the machine that wrote it; no padding. The numbers follow and,
/// as the last eight bytes, their ContentHash.
struct CacheHeader {
  static constexpr std::array<char, 8> our_magic{'\x89', 'p', 'a', 'l', 'p', 'a', 't', 'e'};
  static constexpr std::uint64_t our_byte_order = 0x0102030405060708u;
  static constexpr std::uint64_t our_layout = 3;  ///< increment when the file layout changes

  std::array<char, 8> magic = our_magic;
  std::uint64_t byte_order = our_byte_order;
  std::uint64_t layout = our_layout;
  std::uint64_t version = PALPATE_VERSION;
  CacheKey key;
  std::uint64_t hash = 0;  ///< of all members above

  std::uint64_t right_hash() const noexcept;
};

inline std::uint64_t CacheHeader::right_hash() const noexcept {
  CacheHeader all_but_hash = *this;
  all_but_hash.hash = 0;
  ContentHash h;
  h.add(all_but_hash);
  return h.digest();
}
static_assert(HashableBytes<CacheHeader> && sizeof(CacheHeader) == 160,
              "the header consists of plain words, identical on all platforms");

/// Reads the header of a file positioned at its start. Returns the first problem; `why` describes it.
inline CacheMismatch read_cache_header(std::FILE* file, CacheHeader& header, std::string& why) {
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

/// One cache file during a set-up: `open` compares the key, the caller reads from `payload`, `verify` checks the data
/// read; `store` writes a new file. Throws only when memory runs out; all other problems are reported.
class PreparedCache {
 public:
  PreparedCache(std::string file, const CacheKey& key, CacheReport& report) : key_(key), report_(&report) {
    report.file = std::move(file);
  }

  /// Returns true when a file with this key exists; its payload can then be read.
  bool open();

  BinaryReader& payload() noexcept { return *reader_; }

  /// Call after the payload was read. Returns true when it was complete and undamaged, and nothing follows it.
  bool verify();

  /// Reports that the file is not used. Returns false.
  bool reject(CacheMismatch mismatch, std::string why);

  /// Writes the header, the data of `write(BinaryWriter&)`, and their hash; replaces the file after everything is
  /// written.
  void store(const std::function<void(BinaryWriter&)>& write);

 private:
  void fail(std::string problem) { report_->problem = std::move(problem); }

  CacheKey key_;
  CacheReport* report_;
  File file_;
  std::optional<BinaryReader> reader_;
};

inline bool PreparedCache::open() {
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
  if (!file_) return reject(CacheMismatch::unreadable, "it cannot be read: " + system_message(errno));
  CacheHeader header;
  std::string why;
  CacheMismatch mismatch = read_cache_header(file_.get(), header, why);
  if (mismatch == CacheMismatch::none) mismatch = compare(header.key, key_, why);
  if (mismatch != CacheMismatch::none) return reject(mismatch, std::move(why));
  reader_.emplace(file_.get());
  return true;
}

inline bool PreparedCache::verify() {
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

inline bool PreparedCache::reject(CacheMismatch mismatch, std::string why) {
  file_.reset();
  report_->read = false;
  report_->mismatch = mismatch;
  report_->why = std::move(why);
  return false;
}

inline void PreparedCache::store(const std::function<void(BinaryWriter&)>& write) {
  if (report_->mismatch == CacheMismatch::foreign) {  // for example a mesh, given by mistake
    report_->problem = report_->why + " and was left alone: remove it or give another name";
    return;
  }
  AtomicFile file(report_->file);
  if (file.stream() == nullptr) return fail(file.error());
  CacheHeader header{.key = key_};
  header.hash = header.right_hash();
  errno = 0;
  if (std::fwrite(&header, sizeof header, 1, file.stream()) != 1) return fail(system_message(errno));
  BinaryWriter out(file.stream());
  write(out);
  out.value(out.digest());
  if (!out.good()) return fail(system_message(out.error()));
  if (!file.commit()) return fail(file.error());
  report_->written = true;
  report_->bytes = sizeof header + static_cast<std::size_t>(out.written());
}

}}}  // namespace palpate::detail
