// The numbers of legacy VTK files.
#pragma once

#include <palpate/io/detail/numbers.hpp>

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
  Index integer(const NumberType& type, std::string_view what, Index low, Index high);

  /// The next number of any type but strings, finite.
  double real(const NumberType& type, std::string_view what);

  /// The next number of any type but strings and bits, unchecked: NaN for a word that is no number.
  double any_number(const NumberType& type);

  /// A count of items of `numbers` numbers each, at most as many as fit in the rest of the file.
  Index count(std::string_view what, Index numbers);

  /// Refuses `count` numbers that do not fit into the rest of the file.
  void check_fits(const NumberType& type, Index count) const;

  /// Skips `count` numbers or strings.
  void skip(const NumberType& type, Index count);

  /// Refuses more words on the line where the numbers ended.
  void end(std::string_view what) {
    if (!is_binary) in_.end_line(what);
  }

 private:
  static BinaryLayout layout_of(const NumberType& type);

  /// A string is a line of its own, possibly blank; in binary data a length and its bytes.
  void skip_string();

  TextReader& in_;
};

}}}  // namespace palpate::PALPATE_ABI::io::vtk

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/vtk_numbers.ipp>
#endif
