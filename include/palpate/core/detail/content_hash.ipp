// Definitions of content_hash.hpp.
#pragma once

#include <palpate/core/detail/content_hash.hpp>

#include <cstring>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::uint64_t ContentHash::digest() const noexcept {
  std::uint64_t hash = 0;
  for (const std::uint64_t lane : lanes_) hash = mixed(hash, lane);
  hash ^= hash >> 29;  // each line is a bijection; together they make every output bit depend on every input bit
  hash *= second_prime;
  return hash ^ (hash >> 32);
}

PALPATE_INLINE void ContentHash::add_stripe(std::array<std::uint64_t, lane_count>& lanes,
                                            const unsigned char* bytes) noexcept {
  for (std::size_t i = 0; i < lane_count; ++i) {
    std::uint64_t value;
    std::memcpy(&value, bytes + i * word, word);
    lanes[i] = mixed(lanes[i], value);
  }
}

PALPATE_INLINE void ContentHash::add_bytes(const void* data, std::size_t size) noexcept {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::array<std::uint64_t, lane_count> lanes = lanes_;
  const std::size_t stripes = size / stripe, rest = size % stripe;
  for (std::size_t s = 0; s < stripes; ++s) add_stripe(lanes, bytes + s * stripe);
  if (rest > 0) {
    std::array<unsigned char, stripe> last{};
    std::memcpy(last.data(), bytes + stripes * stripe, rest);
    add_stripe(lanes, last.data());
  }
  lanes[0] = mixed(lanes[0], static_cast<std::uint64_t>(size));
  lanes_ = lanes;
}

}}  // namespace palpate
