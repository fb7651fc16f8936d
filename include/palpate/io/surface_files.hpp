// Writes the surface of a mesh as OBJ or STL.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/message.hpp>
#include <palpate/io/file.hpp>
#include <palpate/mesh/detail/element_layout.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The boundary of a mesh as triangles, outward by the right-hand rule: faces with more than three nodes are split into
/// triangles, mid-edge nodes included.
struct TriangleSurface {
  std::vector<Vector3> positions;
  std::vector<std::array<NodeId, 3>> triangles;
};

/// Refuses a displacement of `size` numbers that is neither empty nor has 3 numbers for each of `nodes` nodes.
inline void check_displacement(Index size, Index nodes) {
  if (size != 0 && size != 3 * nodes)
    refuse(SetupErrorKind::bad_argument, {"a displacement of ", size, " numbers for ", nodes, " nodes"});
}

/// Adds the triangles of a face to the end of `triangles`: `face` lists its nodes.
void add_triangles(const palpate::detail::FaceLayout& layout, const NodeId* face,
                   std::vector<std::array<NodeId, 3>>& triangles);

/// Renumbers the nodes of triangles 0, 1, ... and returns their original ids, ascending.
std::vector<NodeId> compress_nodes(std::vector<std::array<NodeId, 3>>& triangles);

/// The surface of a mesh, moved by `displacement` (3 numbers per node of the mesh, or empty) [m]. Only nodes of the
/// surface are included, in the order of the mesh. Throws bad_argument for a displacement of wrong length, and the
/// errors of extract_boundary.
template <Element E, MeshOf<E> M>
TriangleSurface triangle_surface(const M& mesh, const VectorX& displacement = {}) {
  constexpr const palpate::detail::ElementLayout& element = palpate::detail::element_layout<E>;
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

inline void add_triangles(const palpate::detail::FaceLayout& layout, const NodeId* face,
                          std::vector<std::array<NodeId, 3>>& triangles) {
  for (int t = 0; t < layout.triangle_count; ++t) {
    const std::array<int, 3>& local = layout.triangles[t];
    triangles.push_back({face[local[0]], face[local[1]], face[local[2]]});
  }
}

inline std::vector<NodeId> compress_nodes(std::vector<std::array<NodeId, 3>>& triangles) {
  std::vector<NodeId> nodes;
  nodes.reserve(3 * triangles.size());
  for (const auto& t : triangles) nodes.insert(nodes.end(), t.begin(), t.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (auto& t : triangles)
    for (NodeId& i : t) i = static_cast<NodeId>(std::lower_bound(nodes.begin(), nodes.end(), i) - nodes.begin());
  return nodes;
}

inline void write_obj(const std::string& path, const TriangleSurface& surface) {
  std::string text;
  for (const Vector3& p : surface.positions) {
    const double* x = p.data();
    append(text, {"v ", to_decimal(x[0]), " ", to_decimal(x[1]), " ", to_decimal(x[2]), "\n"});
  }
  for (const auto& t : surface.triangles) append(text, {"f ", t[0] + 1, " ", t[1] + 1, " ", t[2] + 1, "\n"});
  write_file(path, {text});
}

namespace detail {

/// Adds the lowest `bytes` bytes of a number, the lowest first.
inline void put_bytes(std::string& text, std::uint32_t bits, int bytes) {
  for (int i = 0; i < bytes; ++i) text += static_cast<char>((bits >> (8 * i)) & 0xffU);
}

inline void put_point(std::string& text, const double* x) {
  for (int c = 0; c < 3; ++c) put_bytes(text, std::bit_cast<std::uint32_t>(static_cast<float>(x[c])), 4);
}

/// The unit normal of a triangle, zero when it has no area.
inline std::array<double, 3> unit_normal(const double* a, const double* b, const double* c) {
  const double u[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (double& x : n) x = length > 0.0 ? x / length : 0.0;
  return n;
}

}  // namespace detail

inline void write_stl(const std::string& path, const TriangleSurface& surface) {
  std::string text(80, '\0');  // a header that must not begin with "solid"
  detail::put_bytes(text, static_cast<std::uint32_t>(surface.triangles.size()), 4);
  for (const auto& t : surface.triangles) {
    const auto corner = [&](std::size_t a) { return surface.positions[static_cast<std::size_t>(t[a])].data(); };
    detail::put_point(text, detail::unit_normal(corner(0), corner(1), corner(2)).data());
    for (std::size_t a = 0; a < 3; ++a) detail::put_point(text, corner(a));
    detail::put_bytes(text, 0, 2);
  }
  write_file(path, {text});
}

}}}  // namespace palpate::PALPATE_ABI::io
