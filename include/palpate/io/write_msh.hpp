// Writes a mesh with its groups as a Gmsh file (MSH 2.2, ASCII).
#pragma once

#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/mesh/mesh_ref.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The text of an MSH 2.2 file. Region r is physical volume r + 1; group g has the physical tag regions + g + 1 in
/// every dimension in which it has entries. Throws bad_argument for names with quotes or line ends.
std::string msh_text(const MeshRef& mesh);

/// The same for a Mesh.
template <Element E>
std::string msh_text(const Mesh<E>& mesh) {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  return msh_text(mesh_ref(mesh));
}

/// Writes a mesh as MSH 2.2, in metres. read_mesh reads the same nodes, elements, regions and groups, bit for bit, with
/// two exceptions: a region without a group of its name gets one, as every region read from a Gmsh file has, and a
/// region without elements is lost. Throws bad_file, and bad_argument for names with quotes or line ends; then no file
/// is created.
void write_msh(const std::string& path, const MeshRef& mesh);

/// The same for a Mesh.
template <Element E>
void write_msh(const std::string& path, const Mesh<E>& mesh) {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  write_msh(path, mesh_ref(mesh));
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/write_msh.ipp>
#endif
