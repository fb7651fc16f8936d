// Reads the same records from text or from binary data, so that a format with both variants needs only one parser.
#pragma once

#include <palpate/io/detail/text_reader.hpp>

#include <bit>
#include <cstring>

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
double any_decimal(std::string_view word);

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
  Index count(std::string_view what, Index text, Index binary) const;
  /// Three coordinates.
  Vector3 point() const;
  /// Skips reals that are not used.
  void skip_reals(int count, std::string_view what) const;

 private:
  bool is_binary_, swap_;
};

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/numbers.ipp>
#endif
