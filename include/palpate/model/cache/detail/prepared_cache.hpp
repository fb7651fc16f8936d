// The cache file of a prepared model: header, numbers, hash.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/binary_io.hpp>
#include <palpate/core/detail/content_hash.hpp>
#include <palpate/model/cache/cache_report.hpp>
#include <palpate/model/cache/detail/cache_key.hpp>
#include <palpate/version.hpp>

#include <array>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// The first bytes of a cache file, in the byte order of the machine that wrote it; no padding. The numbers follow and,
/// as the last eight bytes, their ContentHash.
struct CacheHeader {
  static constexpr std::array<char, 8> our_magic{'\x89', 'p', 'a', 'l', 'p', 'a', 't', 'e'};
  static constexpr std::uint64_t our_byte_order = 0x0102030405060708u;
  static constexpr std::uint64_t our_layout = 2;  ///< increment when the file layout changes

  std::array<char, 8> magic = our_magic;
  std::uint64_t byte_order = our_byte_order;
  std::uint64_t layout = our_layout;
  std::uint64_t version = PALPATE_VERSION;
  CacheKey key;
  std::uint64_t hash = 0;  ///< of all members above

  std::uint64_t right_hash() const noexcept;
};
static_assert(HashableBytes<CacheHeader> && sizeof(CacheHeader) == 160,
              "the header consists of plain words, identical on all platforms");

/// Reads the header of a file positioned at its start. Returns the first problem; `why` describes it.
CacheMismatch read_cache_header(std::FILE* file, CacheHeader& header, std::string& why);

/// One cache file during a set-up: `open` compares the key, the caller reads from `payload`, `verify` checks the data
/// read; `store` writes a new file. Throws only when memory runs out; all other problems are reported.
class PreparedCache {
 public:
  PreparedCache(std::string file, const CacheKey& key, CacheReport& report);

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
  detail::File file_;
  std::optional<BinaryReader> reader_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/cache/detail/prepared_cache.ipp>
#endif
