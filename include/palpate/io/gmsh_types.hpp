// Element type numbers and small parts that all Gmsh formats share.
#pragma once

#include <palpate/io/node_ids.hpp>
#include <palpate/io/node_order.hpp>
#include <palpate/io/numbers.hpp>

#include <cstdlib>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

/// An element type: its number in the file, its shape and the order of its nodes.
struct Type {
  int number;
  CellShape shape;
  NodeOrder order{};
};

/// Every type a file may hold.
inline constexpr std::array types{
    Type{15, CellShape::point},
    Type{1, CellShape::line2},
    Type{8, CellShape::line3},
    Type{26, CellShape::line4},
    Type{27, CellShape::line5},
    Type{2, CellShape::triangle3},
    Type{9, CellShape::triangle6},
    Type{21, CellShape::triangle10},
    Type{3, CellShape::quadrangle4},
    Type{16, CellShape::quadrangle8},
    Type{10, CellShape::quadrangle9},
    Type{4, CellShape::tetrahedron4},
    Type{11, CellShape::tetrahedron10, gmsh_tetrahedron10},
    Type{29, CellShape::tetrahedron20},
    Type{5, CellShape::hexahedron8},
    Type{17, CellShape::hexahedron20, gmsh_hexahedron20},
    Type{12, CellShape::hexahedron27},
    Type{6, CellShape::prism6},
    Type{18, CellShape::prism15},
    Type{13, CellShape::prism18},
    Type{7, CellShape::pyramid5},
    Type{19, CellShape::pyramid13},
    Type{14, CellShape::pyramid14},
};

/// The type of that number, or nullptr.
constexpr const Type* find_type(Index number) noexcept {
  for (const Type& t : types)
    if (t.number == number) return &t;
  return nullptr;
}

/// The type of that shape.
constexpr const Type& type_of(CellShape shape) noexcept {
  return *std::ranges::find(types, shape, &Type::shape);
}

/// The version of the format, and how numbers are written.
struct Format {
  int major = 4;
  bool is_binary = false;
  bool swap = false;  ///< binary numbers of the other byte order
};

/// A file under way.
struct State {
  explicit State(const std::string& name) : mesh(name) {}
  Format format;
  FileMesh mesh;
  bool has_names = false, has_entities = false, has_nodes = false, has_elements = false;
  std::map<std::vector<int>, std::uint32_t> sets;
  std::map<std::pair<int, Index>, std::uint32_t> entities;  ///< MSH 4: (dimension, entity tag) -> set of physical tags
  Index memberships = 0;                                    ///< MSH 4: of elements in groups
};

/// Reads an element type number; refuses one that is not in `types`.
template <class In>
const Type* read_type(In& in, const TextReader& text) {
  const Index wanted = in.integer("an element type", 1, max_int);
  const Type* type = find_type(wanted);
  if (type == nullptr)
    text.refuse(SetupErrorKind::unsupported, "a known Gmsh element type", '\'' + std::to_string(wanted) + '\'',
                "Mesh again with elements of first or second order");
  return type;
}

/// Reads a physical tag. A minus sign only says that Gmsh turned the orientation round.
template <class In>
int read_physical(In& in) {
  return static_cast<int>(std::abs(in.integer("a physical tag", -max_int, max_int)));
}

/// Requires the line `mark`.
inline void need_mark(TextReader& in, std::string_view mark) {
  in.need_line(mark);
  if (in.line() != mark) in.refuse(SetupErrorKind::bad_file, mark, TextReader::quoted(in.line()));
}

/// Reads a line that holds a count and nothing else.
inline Index read_count(TextReader& in, std::string_view what, Index bytes_each) {
  in.need_line(what);
  const Index count = in.count(what, bytes_each);
  in.end_line(what);
  return count;
}

}}}  // namespace palpate::io::gmsh
