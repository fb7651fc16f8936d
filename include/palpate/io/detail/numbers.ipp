// Definitions of numbers.hpp.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/numbers.hpp>

#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

/// The next `bits` bits as an unsigned number.
inline std::uint64_t binary_bits(TextReader& in, const BinaryLayout& layout, std::string_view what) {
  const std::string_view raw = in.take(static_cast<std::size_t>(layout.bits) / 8, what);
  switch (layout.bits) {
    case 64:
      return from_bytes<std::uint64_t>(raw, layout.swap);
    case 32:
      return from_bytes<std::uint32_t>(raw, layout.swap);
    case 16:
      return from_bytes<std::uint16_t>(raw, layout.swap);
    default:
      return from_bytes<std::uint8_t>(raw, layout.swap);
  }
}

/// The value of such bits as an integer.
inline std::int64_t signed_value(std::uint64_t bits, const BinaryLayout& layout) {
  const bool is_negative = layout.is_signed && ((bits >> (layout.bits - 1)) & 1U) != 0;
  if (is_negative && layout.bits < 64) bits |= ~std::uint64_t{0} << layout.bits;
  return static_cast<std::int64_t>(bits);
}

inline double real_value(std::uint64_t bits, const BinaryLayout& layout) {
  return layout.bits == 32 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                           : std::bit_cast<double>(bits);
}

}  // namespace detail

PALPATE_INLINE double any_binary_number(TextReader& in, const BinaryLayout& layout, bool is_real) {
  const std::uint64_t bits = detail::binary_bits(in, layout, "a number");
  return is_real ? detail::real_value(bits, layout) : static_cast<double>(detail::signed_value(bits, layout));
}

PALPATE_INLINE double any_decimal(std::string_view word) {
  double value = 0.0;
  return parse_decimal(word, value) == std::errc{} ? value : std::numeric_limits<double>::quiet_NaN();
}

PALPATE_INLINE Index binary_integer(TextReader& in, const BinaryLayout& layout, std::string_view what, Index low,
                                    Index high, SetupErrorKind kind) {
  const Index value = detail::signed_value(detail::binary_bits(in, layout, what), layout);
  if (value < low || value > high) in.refuse_range(kind, what, low, high, {"'", value, "'"});
  return value;
}

PALPATE_INLINE double binary_real(TextReader& in, const BinaryLayout& layout, std::string_view what) {
  const double value = detail::real_value(detail::binary_bits(in, layout, what), layout);
  if (!std::isfinite(value))
    in.refuse(SetupErrorKind::non_finite, {what, " in the range of a double"}, {"'", value, "'"});
  return value;
}

PALPATE_INLINE Index Numbers::count(std::string_view what, Index text, Index binary) const {
  if (!is_binary_) return in.count(what, text);
  return long_integer(what, 0, static_cast<Index>(in.bytes_left()) / binary, SetupErrorKind::count_too_large);
}

PALPATE_INLINE Vector3 Numbers::point() const {
  Vector3 x;
  for (int i = 0; i < 3; ++i) x.data()[i] = real("a coordinate");
  return x;
}

PALPATE_INLINE void Numbers::skip_reals(int count, std::string_view what) const {
  if (is_binary_) {
    in.take(static_cast<std::size_t>(count) * 8, what);
    return;
  }
  for (int i = 0; i < count; ++i)
    if (in.token().empty()) in.refuse(SetupErrorKind::bad_file, what, in_quotes({}));
}

}}}  // namespace palpate::PALPATE_ABI::io
