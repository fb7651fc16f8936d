// The same records read from text or from binary data, so that a format with both has one parser.
#pragma once

#include <palpate/io/text_reader.hpp>

#include <bit>
#include <cstring>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The raw bytes of a T, turned round if `swap`.
template <class T>
T from_bytes(std::string_view raw, bool swap) {
  std::array<char, sizeof(T)> bytes{};
  std::copy_n(raw.begin(), sizeof(T), bytes.begin());
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// A binary integer between `low` and `high`. Unsigned numbers beyond 2^63 are refused like negative ones.
template <class T>
Index binary_integer(TextReader& in, bool swap, std::string_view what, Index low, Index high, SetupErrorKind kind) {
  const auto value = static_cast<Index>(from_bytes<T>(in.take(sizeof(T), what), swap));
  if (value < low || value > high)
    in.refuse(kind, std::string(what) + TextReader::range(low, high), '\'' + std::to_string(value) + '\'');
  return value;
}

/// A finite binary number.
template <class T>
double binary_real(TextReader& in, bool swap, std::string_view what) {
  const auto value = static_cast<double>(from_bytes<T>(in.take(sizeof(T), what), swap));
  if (!std::isfinite(value))
    in.refuse(SetupErrorKind::non_finite, std::string(what) + " in the range of a double", '\'' + number(value) + '\'');
  return value;
}

/// Records of text: a line each.
struct TextNumbers {
  TextReader& in;

  void begin(std::string_view what) const { in.need_line(what); }
  void end(std::string_view what) const { in.end_line(what); }
  Index integer(std::string_view what, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range) const {
    return in.integer(what, low, high, kind);
  }
  Index long_integer(std::string_view what, Index low, Index high,
                     SetupErrorKind kind = SetupErrorKind::index_out_of_range) const {
    return in.integer(what, low, high, kind);
  }
  /// A count of things that take `text` bytes or more as text and `binary` bytes or more as binary data.
  Index count(std::string_view what, Index text, Index) const { return in.count(what, text); }
  double real(std::string_view what) const { return in.real(what); }
  /// Reals that nobody looks at.
  void skip_reals(int count, std::string_view what) const {
    for (int i = 0; i < count; ++i)
      if (in.token().empty()) in.refuse(SetupErrorKind::bad_file, what, TextReader::quoted({}));
  }
};

/// Binary records: `int` is 4 bytes, what is long 8, a real 8.
struct BinaryNumbers {
  TextReader& in;
  bool swap;

  void begin(std::string_view) const noexcept {}
  void end(std::string_view) const noexcept {}
  Index integer(std::string_view what, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range) const {
    return binary_integer<std::int32_t>(in, swap, what, low, high, kind);
  }
  Index long_integer(std::string_view what, Index low, Index high,
                     SetupErrorKind kind = SetupErrorKind::index_out_of_range) const {
    return binary_integer<std::uint64_t>(in, swap, what, low, high, kind);
  }
  Index count(std::string_view what, Index, Index binary) const {
    return long_integer(what, 0, static_cast<Index>(in.bytes_left()) / binary, SetupErrorKind::count_too_large);
  }
  double real(std::string_view what) const { return binary_real<double>(in, swap, what); }
  void skip_reals(int count, std::string_view what) const { in.take(static_cast<std::size_t>(count) * 8, what); }
};

}}}  // namespace palpate::io
