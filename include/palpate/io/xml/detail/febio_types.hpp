// Element types of FEBio.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// A type with its shape; the order of nodes is that of VTK (FEBio User Manual, "Elements Section").
struct FebioType {
  std::string_view name;
  CellShape shape;
};

inline constexpr std::array febio_types{
    FebioType{"tet4", CellShape::tetrahedron4},  FebioType{"tet10", CellShape::tetrahedron10},
    FebioType{"hex8", CellShape::hexahedron8},   FebioType{"hex20", CellShape::hexahedron20},
    FebioType{"hex27", CellShape::hexahedron27}, FebioType{"penta6", CellShape::prism6},
    FebioType{"penta15", CellShape::prism15},    FebioType{"pyra5", CellShape::pyramid5},
    FebioType{"pyra13", CellShape::pyramid13},   FebioType{"tri3", CellShape::triangle3},
    FebioType{"tri6", CellShape::triangle6},     FebioType{"quad4", CellShape::quadrangle4},
    FebioType{"quad8", CellShape::quadrangle8},  FebioType{"quad9", CellShape::quadrangle9},
    FebioType{"q4ans", CellShape::quadrangle4},  FebioType{"q4eas", CellShape::quadrangle4},
    FebioType{"line2", CellShape::line2},        FebioType{"truss2", CellShape::line2},
    FebioType{"line3", CellShape::line3},
};

}}}  // namespace palpate::PALPATE_ABI::io::xml
