// Sections of Medit files.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::medit {

/// A section: its keyword in texts and its code in binary files (libMeshb).
struct Section {
  enum Kind { dimension, vertices, cells, order, bezier, real_bits, end };
  std::string_view keyword;
  int code;
  Kind kind;
  CellShape shape = CellShape::point;  ///< of cells, or of those whose order of nodes it gives
};

/// All that are read.
inline constexpr std::array sections{
    Section{"Dimension", 3, Section::dimension},
    Section{"Vertices", 4, Section::vertices},
    Section{"Edges", 5, Section::cells, CellShape::line2},
    Section{"Triangles", 6, Section::cells, CellShape::triangle3},
    Section{"Quadrilaterals", 7, Section::cells, CellShape::quadrangle4},
    Section{"Tetrahedra", 8, Section::cells, CellShape::tetrahedron4},
    Section{"Prisms", 9, Section::cells, CellShape::prism6},
    Section{"Hexahedra", 10, Section::cells, CellShape::hexahedron8},
    Section{"TrianglesP2", 24, Section::cells, CellShape::triangle6},
    Section{"EdgesP2", 25, Section::cells, CellShape::line3},
    Section{"QuadrilateralsQ2", 27, Section::cells, CellShape::quadrangle9},
    Section{"TetrahedraP2", 30, Section::cells, CellShape::tetrahedron10},
    Section{"HexahedraQ2", 33, Section::cells, CellShape::hexahedron27},
    Section{"Pyramids", 49, Section::cells, CellShape::pyramid5},
    Section{"End", 54, Section::end},
    Section{"PrismsP2", 86, Section::cells, CellShape::prism18},
    Section{"PyramidsP2", 87, Section::cells, CellShape::pyramid14},
    Section{"TrianglesP3", 90, Section::cells, CellShape::triangle10},
    Section{"EdgesP3", 92, Section::cells, CellShape::line4},
    Section{"TetrahedraP3", 96, Section::cells, CellShape::tetrahedron20},
    Section{"BezierBasis", 125, Section::bezier},
    Section{"TrianglesP2Ordering", 129, Section::order, CellShape::triangle6},
    Section{"TetrahedraP2Ordering", 133, Section::order, CellShape::tetrahedron10},
    Section{"FloatingPointPrecision", 155, Section::real_bits},
};

/// The section of that keyword, nullptr if it is skipped.
constexpr const Section* find_section(std::string_view keyword) noexcept {
  for (const Section& s : sections)
    if (s.keyword == keyword) return &s;
  return nullptr;
}

/// The same by its code.
constexpr const Section* find_section(Index code) noexcept {
  for (const Section& s : sections)
    if (s.code == code) return &s;
  return nullptr;
}

}}}  // namespace palpate::PALPATE_ABI::io::medit
