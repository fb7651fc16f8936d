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

/// The first bytes of a cache file, in the byte order of the machine that wrote it; no padding. Behind it come the
/// numbers and, as last eight bytes, their ContentHash.
struct CacheHeader {
  static constexpr std::array<char, 8> our_magic{'\x89', 'p', 'a', 'l', 'p', 'a', 't', 'e'};
  static constexpr std::uint64_t our_byte_order = 0x0102030405060708u;
  static constexpr std::uint64_t our_layout = 2;  ///< raise it when anything in the file moves

  std::array<char, 8> magic = our_magic;
  std::uint64_t byte_order = our_byte_order;
  std::uint64_t layout = our_layout;
  std::uint64_t version = PALPATE_VERSION;
  CacheKey key;
  std::uint64_t hash = 0;  ///< of all the above

  std::uint64_t right_hash() const noexcept;
};
static_assert(HashableBytes<CacheHeader> && sizeof(CacheHeader) == 160,
              "the header is plain words, the same everywhere");

/// The header of a file that is open at its start; a mismatch says what is wrong with it, `why` in words.
CacheMismatch read_cache_header(std::FILE* file, CacheHeader& header, std::string& why);

/// One cache file during a set-up: `open` compares, the caller reads from `payload`, `verify` decides whether what was
/// read counts; `store` writes anew. Nothing here throws but memory: what goes wrong is told in the report.
class PreparedCache {
 public:
  PreparedCache(std::string file, const CacheKey& key, CacheReport& report);

  /// True when there is a file with this key; its payload comes next.
  bool open();

  BinaryReader& payload() noexcept { return *reader_; }

  /// After the payload: true when it was complete, undamaged and all there is.
  bool verify();

  /// The file is not used.
  bool reject(CacheMismatch mismatch, std::string why);

  /// Writes header, what `write(BinaryWriter&)` writes, and its hash; replaces the file when all is there.
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
