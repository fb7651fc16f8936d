// Element types of Abaqus, and the faces of its solids.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// A family of element types with one shape: letters after the stem name formulations (R, H, I, M, T ...). The order of
/// nodes is that of VTK for all of them (Abaqus manual, "Three-dimensional solid element library"; solids of other
/// shapes are refused later, and of lines only the set of nodes is used).
struct ElementType {
  std::string_view stem;
  CellShape shape;
};

inline constexpr std::array element_types{
    ElementType{"C3D4", CellShape::tetrahedron4},  ElementType{"C3D10", CellShape::tetrahedron10},
    ElementType{"C3D8", CellShape::hexahedron8},   ElementType{"C3D20", CellShape::hexahedron20},
    ElementType{"C3D6", CellShape::prism6},        ElementType{"C3D15", CellShape::prism15},
    ElementType{"C3D5", CellShape::pyramid5},      ElementType{"C3D13", CellShape::pyramid13},
    ElementType{"DC3D4", CellShape::tetrahedron4}, ElementType{"DC3D10", CellShape::tetrahedron10},
    ElementType{"DC3D8", CellShape::hexahedron8},  ElementType{"DC3D20", CellShape::hexahedron20},
    ElementType{"DC3D6", CellShape::prism6},       ElementType{"DC3D15", CellShape::prism15},
    ElementType{"SC6", CellShape::prism6},         ElementType{"SC8", CellShape::hexahedron8},
    ElementType{"S3", CellShape::triangle3},       ElementType{"STRI3", CellShape::triangle3},
    ElementType{"CPS3", CellShape::triangle3},     ElementType{"CPE3", CellShape::triangle3},
    ElementType{"CAX3", CellShape::triangle3},     ElementType{"M3D3", CellShape::triangle3},
    ElementType{"SFM3D3", CellShape::triangle3},   ElementType{"R3D3", CellShape::triangle3},
    ElementType{"DS3", CellShape::triangle3},      ElementType{"DC2D3", CellShape::triangle3},
    ElementType{"S6", CellShape::triangle6},       ElementType{"STRI65", CellShape::triangle6},
    ElementType{"CPS6", CellShape::triangle6},     ElementType{"CPE6", CellShape::triangle6},
    ElementType{"CAX6", CellShape::triangle6},     ElementType{"M3D6", CellShape::triangle6},
    ElementType{"SFM3D6", CellShape::triangle6},   ElementType{"DS6", CellShape::triangle6},
    ElementType{"DC2D6", CellShape::triangle6},    ElementType{"S4", CellShape::quadrangle4},
    ElementType{"CPS4", CellShape::quadrangle4},   ElementType{"CPE4", CellShape::quadrangle4},
    ElementType{"CAX4", CellShape::quadrangle4},   ElementType{"M3D4", CellShape::quadrangle4},
    ElementType{"SFM3D4", CellShape::quadrangle4}, ElementType{"R3D4", CellShape::quadrangle4},
    ElementType{"DS4", CellShape::quadrangle4},    ElementType{"DC2D4", CellShape::quadrangle4},
    ElementType{"S8", CellShape::quadrangle8},     ElementType{"CPS8", CellShape::quadrangle8},
    ElementType{"CPE8", CellShape::quadrangle8},   ElementType{"CAX8", CellShape::quadrangle8},
    ElementType{"M3D8", CellShape::quadrangle8},   ElementType{"SFM3D8", CellShape::quadrangle8},
    ElementType{"DS8", CellShape::quadrangle8},    ElementType{"DC2D8", CellShape::quadrangle8},
    ElementType{"S9", CellShape::quadrangle9},     ElementType{"M3D9", CellShape::quadrangle9},
    ElementType{"T2D2", CellShape::line2},         ElementType{"T3D2", CellShape::line2},
    ElementType{"B21", CellShape::line2},          ElementType{"B31", CellShape::line2},
    ElementType{"B23", CellShape::line2},          ElementType{"B33", CellShape::line2},
    ElementType{"T2D3", CellShape::line3},         ElementType{"T3D3", CellShape::line3},
    ElementType{"B22", CellShape::line3},          ElementType{"B32", CellShape::line3},
};

/// First letters of types without a shape: springs, masses, connectors, couplings. They are skipped, as are the network
/// elements D of CalculiX.
inline constexpr std::array<std::string_view, 16> skipped_types{
    "MASS",  "ROTARYI", "HEATCAP", "SPRING", "DASHPOT", "CONN",  "GAP",  "DCOUP",
    "JOINT", "ITS",     "ITT",     "PIPE",   "ELBOW",   "FRAME", "R2D2", "RAX2"};

/// The type of that name in upper case, or nullptr.
constexpr const ElementType* find_type(std::string_view name) noexcept {
  for (const ElementType& type : element_types) {
    if (!name.starts_with(type.stem)) continue;
    std::string_view suffix = name.substr(type.stem.size());
    if (suffix.ends_with("R5")) suffix.remove_suffix(1);  // shells with five degrees of freedom
    if (suffix.find_first_of("0123456789") == suffix.npos) return &type;
  }
  return nullptr;
}

constexpr bool is_skipped(std::string_view name) noexcept {
  for (const std::string_view start : skipped_types)
    if (name.starts_with(start)) return true;
  return name == "D";
}

/// Corners of face S1, S2 ... of a tetrahedron and a hexahedron, counterclockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
inline constexpr std::array<std::array<int, 4>, 6> hexahedron_faces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
