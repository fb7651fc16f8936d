// Cell types and number types of legacy VTK files.
#pragma once

#include <palpate/io/file_mesh.hpp>
#include <palpate/io/node_order.hpp>
#include <palpate/io/numbers.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// A cell type: its number in the file, its shape and the order of its nodes.
struct CellType {
  int number;
  CellShape shape;
  NodeOrder order{};
};

/// The types with a fixed number of nodes that are read (vtkCellType.h).
inline constexpr std::array cell_types{
    CellType{1, CellShape::point},
    CellType{3, CellShape::line2},
    CellType{21, CellShape::line3},
    CellType{5, CellShape::triangle3},
    CellType{22, CellShape::triangle6},
    CellType{9, CellShape::quadrangle4},
    CellType{8, CellShape::quadrangle4, pixel_quadrangle4},
    CellType{23, CellShape::quadrangle8},
    CellType{28, CellShape::quadrangle9},
    CellType{10, CellShape::tetrahedron4},
    CellType{24, CellShape::tetrahedron10},
    CellType{12, CellShape::hexahedron8},
    CellType{11, CellShape::hexahedron8, voxel_hexahedron8},
    CellType{25, CellShape::hexahedron20},
    CellType{29, CellShape::hexahedron27},
    CellType{13, CellShape::prism6},
    CellType{26, CellShape::prism15},
    CellType{14, CellShape::pyramid5},
    CellType{27, CellShape::pyramid13},
};

/// The type of that number, or nullptr.
constexpr const CellType* find_cell_type(Index number) noexcept {
  for (const CellType& t : cell_types)
    if (t.number == number) return &t;
  return nullptr;
}

/// A type of numbers in a file. Binary ones are big-endian; `bits` of them take whole bytes together.
struct NumberType {
  enum Kind { integer, unsigned_integer, real };
  std::string_view name;
  Kind kind;
  int bits;
};

/// vtkIdType stands for 4 bytes in files.
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
};

/// ASCII letters in small, whatever the locale.
inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Reads numbers that follow each other on any number of lines, or as big-endian binary data.
class NumberStream {
 public:
  explicit NumberStream(TextReader& in) : in_(in) {}

  bool is_binary = false;

  /// The next word as a number type.
  const NumberType& read_type() {
    const std::string word = lower(in_.token());
    for (const NumberType& t : number_types)
      if (lower(t.name) == word) return t;
    in_.refuse(SetupErrorKind::bad_file, "a type of numbers such as double", TextReader::quoted(word));
  }

  /// The next number of an integer type, between `low` and `high`.
  Index integer(const NumberType& type, std::string_view what, Index low, Index high) {
    constexpr auto kind = SetupErrorKind::index_out_of_range;
    if (!is_binary) {
      in_.need_more(what);
      return in_.integer(what, low, high);
    }
    const bool is_signed = type.kind == NumberType::integer;
    switch (type.bits) {
      case 8:
        return is_signed ? binary_integer<std::int8_t>(in_, swap_, what, low, high, kind)
                         : binary_integer<std::uint8_t>(in_, swap_, what, low, high, kind);
      case 16:
        return is_signed ? binary_integer<std::int16_t>(in_, swap_, what, low, high, kind)
                         : binary_integer<std::uint16_t>(in_, swap_, what, low, high, kind);
      case 32:
        return is_signed ? binary_integer<std::int32_t>(in_, swap_, what, low, high, kind)
                         : binary_integer<std::uint32_t>(in_, swap_, what, low, high, kind);
      default:
        return binary_integer<std::int64_t>(in_, swap_, what, low, high, kind);
    }
  }

  /// The next number of a real type, finite.
  double real(const NumberType& type, std::string_view what) {
    if (is_binary)
      return type.bits == 32 ? binary_real<float>(in_, swap_, what) : binary_real<double>(in_, swap_, what);
    in_.need_more(what);
    return in_.real(what);
  }

  /// A count of things of `numbers` numbers each, no more than the rest of the file can hold.
  Index count(std::string_view what, Index numbers, const NumberType* type = nullptr) {
    const Index bytes = numbers * (is_binary ? (type == nullptr ? 4 : std::max(type->bits / 8, 1)) : 1);
    return in_.count(what, std::max<Index>(bytes, 1));
  }

  /// Passes over `count` numbers nobody needs.
  void skip(const NumberType& type, Index count) {
    const auto left = static_cast<Index>(in_.bytes_left());
    if (count > (is_binary ? left * 8 / type.bits : left))
      in_.refuse(SetupErrorKind::count_too_large, std::to_string(count) + " numbers",
                 std::to_string(left) + " bytes to the end of the file");
    if (is_binary) in_.take(static_cast<std::size_t>((count * type.bits + 7) / 8), "numbers");
    for (Index i = 0; !is_binary && i < count; ++i) {
      in_.need_more("a number");
      in_.token();
    }
    end("the numbers");
  }

  /// Refuses more words on the line where the numbers ended.
  void end(std::string_view what) {
    if (!is_binary) in_.end_line(what);
  }

 private:
  TextReader& in_;
  static constexpr bool swap_ = std::endian::native == std::endian::little;
};

}}}  // namespace palpate::io::vtk
