// Cell types of VTK files.
#pragma once

#include <palpate/io/detail/node_order.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// A cell type: its number in the file, its shape and the order of its nodes.
struct CellType {
  int number;
  CellShape shape;
  NodeOrder order{};
  bool repeats = false;  ///< any number of nodes: a cell of that shape begins at every node but the last ones
};

/// The types that are read (vtkCellType.h).
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
    CellType{2, CellShape::point, {}, true},
    CellType{4, CellShape::line2, {}, true},
};

/// The type of that number, or nullptr.
constexpr const CellType* find_cell_type(Index number) noexcept {
  for (const CellType& t : cell_types)
    if (t.number == number) return &t;
  return nullptr;
}

/// The first type of that shape.
constexpr const CellType& cell_type_of(CellShape shape) noexcept {
  const CellType* t = cell_types.data();
  while (t->shape != shape) ++t;
  return *t;
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
