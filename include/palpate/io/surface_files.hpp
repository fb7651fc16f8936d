// Writes the surface of a mesh as OBJ or STL.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/file.hpp>
#include <palpate/mesh/surface.hpp>

#include <Eigen/Geometry>

#include <bit>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The boundary of a mesh as triangles, outward by the right-hand rule: faces with more than three nodes are cut up,
/// mid-edge nodes included.
struct TriangleSurface {
  std::vector<Vector3> positions;
  std::vector<std::array<NodeId, 3>> triangles;
};

/// The surface of a mesh, moved by `displacement` (3 numbers per node of the mesh, or empty) [m]. Only nodes of the
/// surface come along, in the order of the mesh. Throws bad_argument for a displacement of another length and what
/// extract_boundary throws.
template <Element E, MeshOf<E> M>
TriangleSurface triangle_surface(const M& mesh, const VectorX& displacement = {}) {
  if (displacement.size() != 0 && displacement.size() != 3 * mesh.node_count())
    raise(SetupErrorKind::bad_argument, "a displacement of " + std::to_string(displacement.size()) + " numbers for " +
                                            std::to_string(mesh.node_count()) + " nodes");
  const auto faces = extract_boundary<E>(mesh);
  const auto nodes = nodes_of<E>(faces);
  TriangleSurface surface;
  for (const NodeId i : nodes) {
    Vector3 x = mesh.position(i);
    if (displacement.size() != 0) x += displacement.template segment<3>(3 * static_cast<Index>(i));
    surface.positions.push_back(x);
  }
  const auto place = [&](NodeId i) { return static_cast<NodeId>(std::ranges::lower_bound(nodes, i) - nodes.begin()); };
  for (const auto& face : faces) {
    const auto at = [&](int local) { return place(face.nodes[static_cast<std::size_t>(local)]); };
    with_face_element<E>(face.nodes.size(), [&]<TriangulatedFace F>() {
      for (const auto& [a, b, c] : F::triangles) surface.triangles.push_back({at(a), at(b), at(c)});
    });
  }
  return surface;
}

/// Writes the surface of a mesh as a Wavefront OBJ file; coordinates [m] read back exactly. Throws bad_file and what
/// triangle_surface throws.
template <Element E>
void write_obj(const std::string& path, const Mesh<E>& mesh, const VectorX& displacement = {}) {
  const TriangleSurface surface = triangle_surface<E>(mesh, displacement);
  std::string text;
  for (const Vector3& x : surface.positions)
    text += "v " + to_decimal(x[0]) + ' ' + to_decimal(x[1]) + ' ' + to_decimal(x[2]) + '\n';
  for (const auto& t : surface.triangles)
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' + std::to_string(t[2] + 1) + '\n';
  write_file(path, {text});
}

/// Writes the surface of a mesh as a binary STL file: little-endian floats, so coordinates [m] keep seven digits.
/// Throws bad_file and what triangle_surface throws.
template <Element E>
void write_stl(const std::string& path, const Mesh<E>& mesh, const VectorX& displacement = {}) {
  const TriangleSurface surface = triangle_surface<E>(mesh, displacement);
  std::string text(80, '\0');  // a head that must not begin with "solid"
  const auto put = [&](std::uint32_t bits, int bytes) {
    for (int i = 0; i < bytes; ++i) text += static_cast<char>((bits >> (8 * i)) & 0xffU);
  };
  const auto put_vector = [&](const Vector3& x) {
    for (int c = 0; c < 3; ++c) put(std::bit_cast<std::uint32_t>(static_cast<float>(x[c])), 4);
  };
  put(static_cast<std::uint32_t>(surface.triangles.size()), 4);
  for (const auto& t : surface.triangles) {
    std::array<Vector3, 3> x;
    for (std::size_t a = 0; a < 3; ++a) x[a] = surface.positions[static_cast<std::size_t>(t[a])];
    const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
    const double length = normal.norm();
    put_vector(length > 0.0 ? Vector3(normal / length) : Vector3(Vector3::Zero()));
    for (const Vector3& corner : x) put_vector(corner);
    put(0, 2);
  }
  write_file(path, {text});
}

}}}  // namespace palpate::io
