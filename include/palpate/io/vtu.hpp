// Writes meshes with fields for ParaView and other readers of VTK files.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/file.hpp>
#include <palpate/mesh/mesh_ref.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A field to write: `values` contains the components of node or element 0, then of 1, and so on. The number of
/// components follows from the length: 1 is a scalar, 3 a vector such as a displacement.
struct VtuField {
  std::string name;
  VectorX values;
};

/// The fields of a file; either list may be empty.
struct VtuFields {
  std::vector<VtuField> at_nodes;
  std::vector<VtuField> at_elements;
};

namespace vtk {

/// `text` with the reserved characters of XML escaped.
std::string escape(std::string_view text);

}  // namespace vtk

/// Writes a mesh and fields on it as a VTU file (raw appended data, 64-bit lengths). Positions are the rest positions
/// [m]; ParaView's "Warp By Vector" adds a displacement. The region numbers are written as the element field "region".
/// NaN and infinity are written unchanged. Throws bad_file if the file cannot be written, and bad_argument if a field
/// has the wrong length; then no file is created. Needs memory for one copy of the file.
void write_vtu(const std::string& path, const MeshRef& mesh, const VtuFields& fields = {});

/// The same for any mesh; its arrays are copied first.
template <Element E, MeshOf<E> M>
void write_vtu(const std::string& path, const M& mesh, const VtuFields& fields = {}) {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  const palpate::detail::PlainMesh copy = palpate::detail::plain_copy<E>(mesh);
  write_vtu(path, mesh_ref<E>(copy), fields);
}

/// The same for a Mesh, whose type gives the element; its arrays are not copied.
template <Element E>
void write_vtu(const std::string& path, const Mesh<E>& mesh, const VtuFields& fields = {}) {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  write_vtu(path, mesh_ref(mesh), fields);
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/vtu.ipp>
#endif
