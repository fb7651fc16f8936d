// Definitions of the spheres and cylinders of generators.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The corners of an icosahedron, numbered from 1, and the centre 0, for a sphere of radius one.
inline std::array<Vector3, 13> icosahedron_points() {
  const double golden = std::numbers::phi;
  std::array<Vector3, 13> points{Vector3::Zero()};
  std::size_t next = 1;
  for (int axis = 0; axis < 3; ++axis)
    for (double a : {-1.0, 1.0})
      for (double b : {-golden, golden}) {
        Vector3 p = Vector3::Zero();
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        points[next++] = p.normalized();
      }
  return points;
}

/// The 20 faces: corners that are all one edge apart.
inline std::vector<std::array<int, 3>> icosahedron_faces(const std::array<Vector3, 13>& points) {
  const auto adjacent = [&](int a, int b) {
    return points[static_cast<std::size_t>(a)].dot(points[static_cast<std::size_t>(b)]) > 0.4;  // 1 / sqrt 5
  };
  std::vector<std::array<int, 3>> faces;
  for (int a = 1; a <= 12; ++a)
    for (int b = a + 1; b <= 12; ++b)
      for (int c = b + 1; c <= 12; ++c)
        if (adjacent(a, b) && adjacent(b, c) && adjacent(a, c)) faces.push_back({a, b, c});
  return faces;
}

/// Builds a sphere from 20 tetrahedra between the centre and the faces of an icosahedron, each cut into n^3 by planes
/// parallel to Kuhn's.
class SphereBuilder {
 public:
  SphereBuilder(double radius, int layers) : radius_(radius), layers_(layers), points_(icosahedron_points()) {}

  Mesh<Tet4> build() {
    for (const auto& face : icosahedron_faces(points_)) fill({0, face[0], face[1], face[2]});
    return std::move(mesh_);
  }

 private:
  /// A grid point with n >= i >= j >= k >= 0 has the weights (n - i, i - j, j - k, k); cells outside that simplex are
  /// skipped.
  void fill(const std::array<int, 4>& corners) {
    for (int i = 0; i < layers_; ++i)
      for (int j = 0; j <= i; ++j)
        for (int k = 0; k <= j; ++k)
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
              if (a != b) add_path(corners, {i, j, k}, {a, b, 3 - a - b});
  }

  void add_path(const std::array<int, 4>& corners, std::array<int, 3> place, const std::array<int, 3>& axes) {
    std::array<NodeId, 4> nodes{};
    for (std::size_t step = 0;; ++step) {
      if (place[0] > layers_ || place[1] > place[0] || place[2] > place[1]) return;
      nodes[step] = node(corners, {layers_ - place[0], place[0] - place[1], place[1] - place[2], place[2]});
      if (step == 3) break;
      ++place[static_cast<std::size_t>(axes[step])];
    }
    add_oriented(mesh_, nodes[0], nodes[1], nodes[2], nodes[3]);
  }

  /// The node with these weights of the corners, created on first use. Its key omits zero weights, so that neighbouring
  /// tetrahedra share it.
  NodeId node(const std::array<int, 4>& corners, const std::array<int, 4>& weights) {
    std::array<int, 8> key{};
    std::size_t used = 0;
    Vector3 direction = Vector3::Zero();
    for (std::size_t c = 0; c < 4; ++c) {
      if (weights[c] == 0) continue;
      key[2 * used] = corners[c] + 1;
      key[2 * used++ + 1] = weights[c];
      direction += weights[c] * points_[static_cast<std::size_t>(corners[c])];
    }
    const auto [it, fresh] = nodes_.try_emplace(key, static_cast<NodeId>(mesh_.positions.size()));
    if (fresh) {
      const int layer = layers_ - weights[0];  // layers are pushed out to spheres
      mesh_.positions.push_back(layer == 0 ? Vector3(Vector3::Zero())
                                           : Vector3(radius_ * layer / layers_ * direction.normalized()));
    }
    return it->second;
  }

  double radius_;
  int layers_;
  std::array<Vector3, 13> points_;
  std::map<std::array<int, 8>, NodeId> nodes_;
  Mesh<Tet4> mesh_;
};

/// Node of a disk of rings: the centre, then 6 r nodes on ring r at equal angles.
inline NodeId ring_node(int ring, int place) noexcept {
  return ring == 0 ? 0 : static_cast<NodeId>(1 + 3 * ring * (ring - 1) + place % (6 * ring));
}

/// The 6 n^2 triangles of a disk of n rings.
inline std::vector<std::array<NodeId, 3>> disk_triangles(int rings) {
  std::vector<std::array<NodeId, 3>> triangles;
  for (int r = 0; r < rings; ++r)
    for (int sector = 0; sector < 6; ++sector)
      for (int j = 0; j <= r; ++j) {
        const int in = sector * r + j, out = sector * (r + 1) + j;
        triangles.push_back({ring_node(r, in), ring_node(r + 1, out), ring_node(r + 1, out + 1)});
        if (j < r) triangles.push_back({ring_node(r, in), ring_node(r + 1, out + 1), ring_node(r, in + 1)});
      }
  return triangles;
}

/// Three tetrahedra in the prism over a triangle. Every side is cut from its lower node number at the bottom to the
/// higher one at the top, so that neighbours conform.
inline void split_prism(Mesh<Tet4>& mesh, std::array<NodeId, 3> triangle, NodeId bottom, NodeId top) {
  std::ranges::sort(triangle);
  const auto [a, b, c] = triangle;
  add_oriented(mesh, a + bottom, b + bottom, c + bottom, c + top);
  add_oriented(mesh, a + bottom, b + bottom, b + top, c + top);
  add_oriented(mesh, a + bottom, a + top, b + top, c + top);
}

inline void require_round(double radius, double height, int count) {
  if (!(radius > 0.0) || !(height > 0.0) || !std::isfinite(radius) || !std::isfinite(height) || count < 1)
    raise(SetupErrorKind::bad_argument,
          "a round body of radius " + number(radius) + ", height " + number(height) + " and refinement " +
              std::to_string(count),
          "All must be positive");
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Mesh<Tet4> sphere_tet4(double radius, int refinement) {
  detail::require_round(radius, radius, refinement);
  if (refinement > 400) raise(SetupErrorKind::count_too_large, "a sphere of " + std::to_string(refinement) + " layers");
  Mesh<Tet4> mesh = detail::SphereBuilder(radius, refinement).build();
  detail::add_boundary_group(mesh, extract_boundary<Tet4>(mesh), surface_group,
                             [](const BoundaryFace&) { return true; });
  return mesh;
}

PALPATE_INLINE Mesh<Tet4> cylinder_tet4(double radius, double height, int n) {
  detail::require_round(radius, height, n);
  const double wanted = std::max(1.0, std::round(height / radius * n));
  if (18.0 * n * n * wanted > 1e8)
    raise(SetupErrorKind::count_too_large, "the cylinder would have more than 10^8 elements");
  const int layers = static_cast<int>(wanted);
  const NodeId per_layer = detail::ring_node(n, 0) + 6 * n;
  Mesh<Tet4> mesh;
  for (int l = 0; l <= layers; ++l)
    for (int r = 0; r <= n; ++r)
      for (int place = 0; place < std::max(1, 6 * r); ++place) {
        const double angle = r == 0 ? 0.0 : 2.0 * std::numbers::pi * place / (6 * r), distance = radius * r / n;
        mesh.positions.emplace_back(distance * std::cos(angle), distance * std::sin(angle), height * l / layers);
      }
  const auto triangles = detail::disk_triangles(n);
  for (int l = 0; l < layers; ++l)
    for (const auto& triangle : triangles) detail::split_prism(mesh, triangle, l * per_layer, (l + 1) * per_layer);
  const auto boundary = extract_boundary<Tet4>(mesh);
  const auto within = [](const BoundaryFace& f, NodeId first, NodeId last) {
    return std::ranges::all_of(f.nodes, [=](NodeId i) { return i >= first && i < last; });
  };
  const auto bottom = [&](const BoundaryFace& f) { return within(f, 0, per_layer); };
  const auto top = [&](const BoundaryFace& f) { return within(f, layers * per_layer, (layers + 1) * per_layer); };
  detail::add_boundary_group(mesh, boundary, "bottom", bottom);
  detail::add_boundary_group(mesh, boundary, "top", top);
  detail::add_boundary_group(mesh, boundary, "side", [&](const BoundaryFace& f) { return !bottom(f) && !top(f); });
  return mesh;
}

}}  // namespace palpate
