// The numbers of legacy VTK files.
#pragma once

#include <palpate/io/detail/numbers.hpp>

#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// A type of numbers in a file, or of strings. Binary ones are big-endian; numbers of type `bit` are packed into bytes.
struct NumberType {
  enum Kind { integer, unsigned_integer, real, text };
  std::string_view name;
  Kind kind;
  int bits;
};

/// vtkIdType has 4 bytes in files.
inline constexpr std::array number_types{
    NumberType{"bit", NumberType::unsigned_integer, 1},
    NumberType{"unsigned_char", NumberType::unsigned_integer, 8},
    NumberType{"char", NumberType::integer, 8},
    NumberType{"signed_char", NumberType::integer, 8},
    NumberType{"unsigned_short", NumberType::unsigned_integer, 16},
    NumberType{"short", NumberType::integer, 16},
    NumberType{"unsigned_int", NumberType::unsigned_integer, 32},
    NumberType{"int", NumberType::integer, 32},
    NumberType{"vtkIdType", NumberType::integer, 32},
    NumberType{"unsigned_long", NumberType::unsigned_integer, 64},
    NumberType{"long", NumberType::integer, 64},
    NumberType{"vtktypeint64", NumberType::integer, 64},
    NumberType{"vtktypeuint64", NumberType::unsigned_integer, 64},
    NumberType{"float", NumberType::real, 32},
    NumberType{"double", NumberType::real, 64},
    NumberType{"string", NumberType::text, 8},
    NumberType{"utf8_string", NumberType::text, 8},
    NumberType{"vtktypeint8", NumberType::integer, 8},
    NumberType{"vtktypeuint8", NumberType::unsigned_integer, 8},
    NumberType{"vtktypeint16", NumberType::integer, 16},
    NumberType{"vtktypeuint16", NumberType::unsigned_integer, 16},
    NumberType{"vtktypeint32", NumberType::integer, 32},
    NumberType{"vtktypeuint32", NumberType::unsigned_integer, 32},
    NumberType{"vtktypefloat32", NumberType::real, 32},
    NumberType{"vtktypefloat64", NumberType::real, 64},
};

/// ASCII letters in lower case, independent of the locale.
std::string lower(std::string_view text);

/// Whether two words are equal, ignoring case.
bool same_word(std::string_view a, std::string_view b) noexcept;

/// Reads consecutive numbers on any number of lines, or as big-endian binary data.
class NumberStream {
 public:
  explicit NumberStream(TextReader& in) : in_(in) {}

  bool is_binary = false;

  /// The next word as a number type.
  const NumberType& read_type();

  /// The next number of an integer type, between `low` and `high`.
  Index integer(const NumberType& type, std::string_view what, Index low, Index high) {
    if (is_binary) return binary_integer(in_, layout_of(type), what, low, high, SetupErrorKind::index_out_of_range);
    in_.need_more(what);
    return in_.integer(what, low, high);
  }

  /// The next number of any type but strings, finite.
  double real(const NumberType& type, std::string_view what);

  /// The next number of any type but strings and bits, unchecked: NaN for a word that is no number.
  double any_number(const NumberType& type) {
    if (is_binary) return any_binary_number(in_, layout_of(type), type.kind == NumberType::real);
    in_.need_more("a number");
    return any_decimal(in_.token());
  }

  /// A count of items of `numbers` numbers each, at most as many as fit in the rest of the file.
  Index count(std::string_view what, Index numbers) { return in_.count(what, numbers * (is_binary ? 4 : 1)); }

  /// Refuses `count` numbers that do not fit into the rest of the file.
  PALPATE_COLD void check_fits(const NumberType& type, Index count) const {
    const auto left = static_cast<Index>(in_.bytes_left());
    if (count > (is_binary ? left * 8 / type.bits : left))
      in_.refuse(SetupErrorKind::count_too_large, {count, " numbers"}, {left, " bytes to the end of the file"});
  }

  /// Skips `count` numbers or strings.
  void skip(const NumberType& type, Index count);

  /// Refuses more words on the line where the numbers ended.
  void end(std::string_view what) {
    if (!is_binary) in_.end_line(what);
  }

 private:
  static BinaryLayout layout_of(const NumberType& type) {
    return {type.bits < 8 ? 64 : type.bits, type.kind == NumberType::integer,
            std::endian::native == std::endian::little};
  }

  /// A string is a line of its own, possibly blank; in binary data a length and its bytes.
  void skip_string();

  TextReader& in_;
};

namespace detail {

constexpr char small_letter(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace detail

PALPATE_COLD inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = detail::small_letter(c);
  return out;
}

PALPATE_COLD inline bool same_word(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (detail::small_letter(a[i]) != detail::small_letter(b[i])) return false;
  return true;
}

PALPATE_COLD inline const NumberType& NumberStream::read_type() {
  const std::string_view word = in_.token();
  for (const NumberType& t : number_types)
    if (same_word(t.name, word)) return t;
  in_.refuse(SetupErrorKind::bad_file, "a type of numbers such as double", in_quotes(lower(word)));
}

inline double NumberStream::real(const NumberType& type, std::string_view what) {
  if (type.kind != NumberType::real) {
    constexpr Index limit = std::numeric_limits<Index>::max();
    return static_cast<double>(integer(type, what, -limit, limit));
  }
  if (is_binary) return binary_real(in_, layout_of(type), what);
  in_.need_more(what);
  return in_.real(what);
}

/// The two highest bits of the first byte are 3, 2, 1 or 0 for a length in 1, 2, 4 or 8 bytes, of which they are part
/// (vtkDataWriter).
PALPATE_COLD inline void NumberStream::skip_string() {
  if (!is_binary) {
    if (!in_.next_raw_line()) in_.refuse(SetupErrorKind::bad_file, "a string", "the end of the file");
    return;
  }
  std::uint64_t length = from_bytes<std::uint8_t>(in_.read_bytes(1, "a string"), false);
  const std::size_t more = (std::size_t{1} << (3U - length / 64U)) - 1U;
  length %= 64U;
  for (const char c : in_.read_bytes(more, "the length of a string"))
    length = length << 8U | static_cast<unsigned char>(c);
  in_.read_bytes(static_cast<std::size_t>(length), "a string");
}

inline void NumberStream::skip(const NumberType& type, Index count) {
  check_fits(type, count);
  if (type.kind == NumberType::text) {
    for (Index i = 0; i < count; ++i) skip_string();
    return;
  }
  if (is_binary) in_.read_bytes(static_cast<std::size_t>((count * type.bits + 7) / 8), "numbers");
  for (Index i = 0; !is_binary && i < count; ++i) {
    in_.need_more("a number");
    in_.token();
  }
  end("the numbers");
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
