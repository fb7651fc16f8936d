// Reads the same records from text or from binary data, so that a format with both variants needs only one parser.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/text_reader.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Converts raw bytes to a T, with the byte order reversed if `swap`.
template <class T>
T from_bytes(std::string_view raw, bool swap) {
  std::array<char, sizeof(T)> bytes{};
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = raw[swap ? sizeof(T) - 1 - i : i];
  return std::bit_cast<T>(bytes);
}

/// Format of a binary number of `bits` bits.
struct BinaryLayout {
  int bits;
  bool is_signed;
  bool swap;  ///< byte order opposite to that of this machine
};

/// A binary integer between `low` and `high`. Unsigned numbers beyond 2^63 are refused like negative ones.
Index binary_integer(TextReader& in, const BinaryLayout& layout, std::string_view what, Index low, Index high,
                     SetupErrorKind kind);

/// A finite binary number of 32 or 64 bits.
double binary_real(TextReader& in, const BinaryLayout& layout, std::string_view what);

/// A binary number, unchecked.
double any_binary_number(TextReader& in, const BinaryLayout& layout, bool is_real);

/// The number that a word represents, NaN if it is none.
inline double any_decimal(std::string_view word) {
  double value = 0.0;
  return parse_decimal(word, value) == std::errc{} ? value : std::numeric_limits<double>::quiet_NaN();
}

/// Records of numbers: one line each in text; in binary data an integer takes 4 bytes, a long_integer 8, a real 8.
class Numbers {
 public:
  /// Binary numbers are read with reversed byte order if `swap`.
  explicit Numbers(TextReader& reader, bool is_binary = false, bool swap = false)
      : in(reader), is_binary_(is_binary), swap_(swap) {}

  TextReader& in;

  void begin(std::string_view what) const {
    if (!is_binary_) in.need_line(what);
  }
  /// The same where a record may begin on the line of the previous one.
  void begin_anywhere(std::string_view what) const {
    if (!is_binary_) in.need_more(what);
  }
  void end(std::string_view what) const {
    if (!is_binary_) in.end_line(what);
  }
  Index integer(std::string_view what, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range) const {
    return is_binary_ ? binary_integer(in, {32, true, swap_}, what, low, high, kind)
                      : in.integer(what, low, high, kind);
  }
  Index long_integer(std::string_view what, Index low, Index high,
                     SetupErrorKind kind = SetupErrorKind::index_out_of_range) const {
    return is_binary_ ? binary_integer(in, {64, false, swap_}, what, low, high, kind)
                      : in.integer(what, low, high, kind);
  }
  double real(std::string_view what) const {
    return is_binary_ ? binary_real(in, {64, true, swap_}, what) : in.real(what);
  }
  /// A count of items that take at least `text` bytes as text and at least `binary` bytes as binary data.
  Index count(std::string_view what, Index text, Index binary) const {
    if (!is_binary_) return in.count(what, text);
    return long_integer(what, 0, static_cast<Index>(in.bytes_left()) / binary, SetupErrorKind::count_too_large);
  }
  /// Three coordinates.
  Vector3 point() const {
    Vector3 x;
    for (int i = 0; i < 3; ++i) x.data()[i] = real("a coordinate");
    return x;
  }
  /// Skips reals that are not used.
  void skip_reals(int count, std::string_view what) const;

 private:
  bool is_binary_, swap_;
};

namespace detail {

/// The next `bits` bits as an unsigned number.
inline std::uint64_t binary_bits(TextReader& in, const BinaryLayout& layout, std::string_view what) {
  const std::string_view raw = in.read_bytes(static_cast<std::size_t>(layout.bits) / 8, what);
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

inline double any_binary_number(TextReader& in, const BinaryLayout& layout, bool is_real) {
  const std::uint64_t bits = detail::binary_bits(in, layout, "a number");
  return is_real ? detail::real_value(bits, layout) : static_cast<double>(detail::signed_value(bits, layout));
}

inline Index binary_integer(TextReader& in, const BinaryLayout& layout, std::string_view what, Index low, Index high,
                            SetupErrorKind kind) {
  const Index value = detail::signed_value(detail::binary_bits(in, layout, what), layout);
  if (value < low || value > high) in.refuse_range(kind, what, low, high, {"'", value, "'"});
  return value;
}

inline double binary_real(TextReader& in, const BinaryLayout& layout, std::string_view what) {
  const double value = detail::real_value(detail::binary_bits(in, layout, what), layout);
  if (!std::isfinite(value))
    in.refuse(SetupErrorKind::non_finite, {what, " in the range of a double"}, {"'", value, "'"});
  return value;
}

inline void Numbers::skip_reals(int count, std::string_view what) const {
  if (is_binary_) {
    in.read_bytes(static_cast<std::size_t>(count) * 8, what);
    return;
  }
  for (int i = 0; i < count; ++i)
    if (in.token().empty()) in.refuse(SetupErrorKind::bad_file, what, in_quotes({}));
}

}}}  // namespace palpate::PALPATE_ABI::io
