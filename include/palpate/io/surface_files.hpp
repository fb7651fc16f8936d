// Writes the surface of a mesh as OBJ or STL.
#pragma once

#include <palpate/mesh/detail/element_layout.hpp>
#include <palpate/mesh/surface.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The boundary of a mesh as triangles, outward by the right-hand rule: faces with more than three nodes are split into
/// triangles, mid-edge nodes included.
struct TriangleSurface {
  std::vector<Vector3> positions;
  std::vector<std::array<NodeId, 3>> triangles;
};

/// Refuses a displacement of `size` numbers that is neither empty nor has 3 numbers for each of `nodes` nodes.
void check_displacement(Index size, Index nodes);

/// Adds the triangles of a face to the end of `triangles`: `face` lists its nodes.
void add_triangles(const FaceLayout& layout, const NodeId* face, std::vector<std::array<NodeId, 3>>& triangles);

/// Renumbers the nodes of triangles 0, 1, ... and returns their original ids, ascending.
std::vector<NodeId> compress_nodes(std::vector<std::array<NodeId, 3>>& triangles);

/// The surface of a mesh, moved by `displacement` (3 numbers per node of the mesh, or empty) [m]. Only nodes of the
/// surface are included, in the order of the mesh. Throws bad_argument for a displacement of wrong length, and the
/// errors of extract_boundary.
template <Element E, MeshOf<E> M>
TriangleSurface triangle_surface(const M& mesh, const VectorX& displacement = {}) {
  constexpr const ElementLayout& element = element_layout<E>;
  static_assert(element.face.triangle_count > 0 && (element.small_face.nodes == 0) == !HasSmallFace<E>);
  check_displacement(displacement.size(), mesh.node_count());
  TriangleSurface surface;
  for (const auto& face : extract_boundary<E>(mesh)) {
    const bool is_small = static_cast<int>(face.nodes.size()) == element.small_face.nodes;
    add_triangles(is_small ? element.small_face : element.face, &*face.nodes.begin(), surface.triangles);
  }
  for (const NodeId i : compress_nodes(surface.triangles)) {
    Vector3 x = mesh.position(i);
    if (displacement.size() != 0)
      for (int c = 0; c < 3; ++c) x[c] += displacement[3 * static_cast<Index>(i) + c];
    surface.positions.push_back(x);
  }
  return surface;
}

/// Writes a surface as a Wavefront OBJ file; coordinates [m] read back exactly. Throws bad_file.
void write_obj(const std::string& path, const TriangleSurface& surface);

/// Writes a surface as a binary STL file: little-endian floats, so coordinates [m] keep seven digits. Throws bad_file.
void write_stl(const std::string& path, const TriangleSurface& surface);

/// Writes the surface of a mesh as a Wavefront OBJ file. Throws bad_file and the errors of triangle_surface.
template <Element E>
void write_obj(const std::string& path, const Mesh<E>& mesh, const VectorX& displacement = {}) {
  write_obj(path, triangle_surface<E>(mesh, displacement));
}

/// Writes the surface of a mesh as a binary STL file. Throws bad_file and the errors of triangle_surface.
template <Element E>
void write_stl(const std::string& path, const Mesh<E>& mesh, const VectorX& displacement = {}) {
  write_stl(path, triangle_surface<E>(mesh, displacement));
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/surface_files.ipp>
#endif
