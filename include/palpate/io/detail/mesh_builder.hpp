// Converts a parsed file to a mesh of one element type.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/file_mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The mesh of a parsed file with elements of that layout, for which solid_shape must be valid; `numbering`, if given,
/// receives the ids of the file.
PlainMesh build_plain_mesh(FileMesh file, const ElementLayout& element, double scale, MeshNumbering* numbering);

/// The same as a mesh of E.
template <Element E>
Mesh<E> build_mesh(FileMesh file, double scale, MeshNumbering* numbering) {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  return to_mesh<E>(build_plain_mesh(std::move(file), element_layout<E>, scale, numbering));
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/mesh_builder.ipp>
#endif
