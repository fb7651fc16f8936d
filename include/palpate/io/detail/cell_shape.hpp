// Cell shapes in mesh files, and the positions of their nodes.
#pragma once

#include <palpate/mesh/detail/element_layout.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A shape with its number of nodes. The order of nodes inside this folder is VTK's (The VTK User's Guide, "VTK File
/// Formats", figures of the linear and quadratic cells); every format has a NodeOrder that maps to it.
enum class CellShape : std::uint8_t {
  point,
  line2,
  line3,
  line4,
  line5,
  triangle3,
  triangle6,
  triangle10,
  quadrangle4,
  quadrangle8,
  quadrangle9,
  tetrahedron4,
  tetrahedron10,
  tetrahedron20,
  hexahedron8,
  hexahedron20,
  hexahedron27,
  prism6,
  prism15,
  prism18,
  pyramid5,
  pyramid13,
  pyramid14,
};

/// The properties of a shape, the same in every format.
struct ShapeFacts {
  int dimension;
  int nodes;
  std::string_view name;
};

/// One entry per CellShape.
inline constexpr std::array<ShapeFacts, 23> shape_facts{{
    {0, 1, "point"},
    {1, 2, "2-node line"},
    {1, 3, "3-node line"},
    {1, 4, "4-node line"},
    {1, 5, "5-node line"},
    {2, 3, "3-node triangle"},
    {2, 6, "6-node triangle"},
    {2, 10, "10-node triangle"},
    {2, 4, "4-node quadrangle"},
    {2, 8, "8-node quadrangle"},
    {2, 9, "9-node quadrangle"},
    {3, 4, "4-node tetrahedron"},
    {3, 10, "10-node tetrahedron"},
    {3, 20, "20-node tetrahedron"},
    {3, 8, "8-node hexahedron"},
    {3, 20, "20-node hexahedron"},
    {3, 27, "27-node hexahedron"},
    {3, 6, "6-node prism"},
    {3, 15, "15-node prism"},
    {3, 18, "18-node prism"},
    {3, 5, "5-node pyramid"},
    {3, 13, "13-node pyramid"},
    {3, 14, "14-node pyramid"},
}};

constexpr const ShapeFacts& facts(CellShape shape) noexcept {
  return shape_facts[static_cast<std::size_t>(shape)];
}

/// The shape of an element, deduced from its numbers of nodes and faces, so that user-defined elements can be read
/// without registration.
constexpr CellShape solid_shape(const palpate::detail::ElementLayout& element) noexcept {
  if (element.face_count == 4) return element.nodes == 4 ? CellShape::tetrahedron4 : CellShape::tetrahedron10;
  return element.nodes == 8 ? CellShape::hexahedron8 : CellShape::hexahedron20;
}

/// The shape of the faces of a solid.
constexpr CellShape face_shape(CellShape solid) noexcept {
  switch (solid) {
    case CellShape::tetrahedron4:
      return CellShape::triangle3;
    case CellShape::tetrahedron10:
      return CellShape::triangle6;
    case CellShape::hexahedron8:
      return CellShape::quadrangle4;
    default:
      return CellShape::quadrangle8;
  }
}

/// The shape of element E; a shape that no file format supports is a compile error.
template <Element E>
constexpr CellShape solid_shape() {
  constexpr std::size_t faces = E::faces.size();
  static_assert((faces == 4 && (E::nodes == 4 || E::nodes == 10)) || (faces == 6 && (E::nodes == 8 || E::nodes == 20)),
                "files are read into tetrahedra of 4 or 10 nodes and hexahedra of 8 or 20 nodes");
  constexpr CellShape shape = solid_shape(palpate::detail::element_layout<E>);
  static_assert(facts(shape).nodes == E::nodes && facts(face_shape(shape)).nodes == E::Face::nodes);
  return shape;
}

/// order[k] is the position of VTK's node k in the file's node list; empty if the two orders agree.
using NodeOrder = std::span<const std::uint8_t>;

}}}  // namespace palpate::PALPATE_ABI::io
