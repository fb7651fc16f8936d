// Element type numbers of Gmsh.
#pragma once

#include <palpate/io/detail/node_order.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

/// An element type: its number in the file, its shape and the order of its nodes.
struct Type {
  int number;
  CellShape shape;
  NodeOrder order{};
};

/// All types that a file may contain.
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
  const Type* t = types.data();
  while (t->shape != shape) ++t;
  return *t;
}

}}}  // namespace palpate::PALPATE_ABI::io::gmsh
