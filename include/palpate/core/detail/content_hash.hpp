// A fast hash of arrays, to detect changes.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Types without padding, whose bytes are their value. Floating-point types are included: different hashes for 0 and -0
/// are harmless.
template <class T>
concept HashableBytes = std::same_as<T, double> || std::same_as<T, float> ||
    (std::is_trivially_copyable_v<T>&& std::has_unique_object_representations_v<T>);

/// 64-bit hash over a sequence of arrays, at memory speed: four independent lanes of multiply and rotate, similar to
/// xxHash64 (Y. Collet) but not equal to it. Every step is a bijection of its lane, so a change within one aligned word
/// of eight bytes is always detected; any other change is missed with probability 2^-64. Not cryptographic: it detects
/// accidental changes, not forgeries. Array lengths are hashed too. Depends on the byte order.
class ContentHash {
 public:
  template <HashableBytes T>
  void add(std::span<const T> values) noexcept {
    add_bytes(values.data(), values.size_bytes());
  }
  template <HashableBytes T>
  void add(const T& value) noexcept {
    add_bytes(&value, sizeof value);
  }
  void add(std::string_view text) noexcept { add_bytes(text.data(), text.size()); }

  std::uint64_t digest() const noexcept;

 private:
  static constexpr std::size_t lane_count = 4, word = sizeof(std::uint64_t), stripe = lane_count * word;
  static constexpr std::uint64_t first_prime = 0x9e3779b185ebca87u, second_prime = 0xc2b2ae3d27d4eb4fu;

  /// A bijection of `state` for every `value`, and of `value` for every `state`.
  static constexpr std::uint64_t mixed(std::uint64_t state, std::uint64_t value) noexcept {
    return std::rotl(state + value * second_prime, 31) * first_prime;
  }

  static void add_stripe(std::array<std::uint64_t, lane_count>& lanes, const unsigned char* bytes) noexcept;

  void add_bytes(const void* data, std::size_t size) noexcept;

  std::array<std::uint64_t, lane_count> lanes_{first_prime, second_prime, ~first_prime, ~second_prime};
};

inline std::uint64_t ContentHash::digest() const noexcept {
  std::uint64_t hash = 0;
  for (const std::uint64_t lane : lanes_) hash = mixed(hash, lane);
  hash ^= hash >> 29;  // each line is a bijection; together they make every output bit depend on every input bit
  hash *= second_prime;
  return hash ^ (hash >> 32);
}

inline void ContentHash::add_stripe(std::array<std::uint64_t, lane_count>& lanes, const unsigned char* bytes) noexcept {
  for (std::size_t i = 0; i < lane_count; ++i) {
    std::uint64_t value;
    std::memcpy(&value, bytes + i * word, word);
    lanes[i] = mixed(lanes[i], value);
  }
}

inline void ContentHash::add_bytes(const void* data, std::size_t size) noexcept {
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

}}}  // namespace palpate::detail
