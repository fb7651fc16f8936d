#pragma once

#include "catch.hpp"

#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/generators.hpp>

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <set>

namespace test {

using namespace palpate;

/// Runs `what`, checks that it is refused with this kind, and returns the problem.
inline SetupProblem refused(SetupErrorKind kind, const std::function<void()>& what) {
  try {
    what();
  } catch (const SetupError& error) {
    INFO(error.what());
    CHECK(to_string(error.kind()) == to_string(kind));
    return error.problem();
  }
  FAIL("not refused, expected " << to_string(kind));
  return {};
}

/// Measures of a closed triangle surface: area_vector and irregular_edges must be zero, euler must be two.
struct SurfaceMeasures {
  Vector3 area_vector = Vector3::Zero();
  double area = 0.0;
  double volume = 0.0;        ///< by the divergence theorem
  Index euler = 0;            ///< vertices - edges + faces
  Index irregular_edges = 0;  ///< edges not shared by exactly two faces
};

template <class Faces>
SurfaceMeasures measure_surface(const std::vector<Vector3>& positions, const Faces& faces) {
  SurfaceMeasures m;
  std::set<NodeId> vertices;
  std::map<std::pair<NodeId, NodeId>, int> edges;
  const Vector3 origin = positions.front();
  for (const auto& f : faces) {
    const auto at = [&](std::size_t a) -> Vector3 { return positions[static_cast<std::size_t>(f[a])] - origin; };
    const Vector3 half = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    m.area_vector += half;
    m.area += half.norm();
    m.volume += half.dot(at(0)) / 3.0;
    for (std::size_t a = 0; a < 3; ++a) {
      vertices.insert(f[a]);
      ++edges[std::minmax(f[a], f[(a + 1) % 3])];
    }
  }
  m.euler = static_cast<Index>(vertices.size()) - static_cast<Index>(edges.size()) + static_cast<Index>(faces.size());
  for (const auto& [edge, count] : edges) m.irregular_edges += count == 2 ? 0 : 1;
  return m;
}

inline SurfaceMeasures measure_boundary(const Mesh<Tet4>& mesh) {
  std::vector<std::array<NodeId, 3>> faces;
  for (const auto& f : extract_boundary<Tet4>(mesh)) faces.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
  return measure_surface(mesh.positions, faces);
}

/// The mesh with every position multiplied and then shifted.
inline Mesh<Tet4> transformed(Mesh<Tet4> mesh, double scale, const Vector3& shift = Vector3::Zero()) {
  for (Vector3& x : mesh.positions) x = scale * x + shift;
  return mesh;
}

/// Two meshes in one, sharing nothing. Groups are dropped.
inline Mesh<Tet4> side_by_side(const Mesh<Tet4>& a, const Mesh<Tet4>& b) {
  Mesh<Tet4> both;
  both.positions = a.positions;
  both.elements = a.elements;
  both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
  for (auto element : b.elements) {
    for (NodeId& i : element) i += static_cast<NodeId>(a.node_count());
    both.elements.push_back(element);
  }
  return both;
}

/// One tetrahedron with a right corner.
inline Mesh<Tet4> corner_tetrahedron() {
  Mesh<Tet4> mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.elements = {{0, 1, 2, 3}};
  return mesh;
}

}  // namespace test
