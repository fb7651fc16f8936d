// Meshes of any element: boxes, and boxes mapped to other shapes. Elements with curved edges follow the shape.
#pragma once

#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/testing/random.hpp>

#include <cmath>
#include <numbers>
#include <utility>

namespace accuracy {

using namespace palpate;

/// The same mesh as one of another element with the same nodes.
template <Element To, Element From>
Mesh<To> read_as(Mesh<From> mesh) {
  static_assert(To::nodes == From::nodes && To::faces == From::faces);
  Mesh<To> same;
  same.positions = std::move(mesh.positions);
  same.elements = std::move(mesh.elements);
  same.regions = std::move(mesh.regions);
  same.region_names = std::move(mesh.region_names);
  same.groups = std::move(mesh.groups);
  return same;
}

/// A box [0, size] of equal cells, each split into six tetrahedra for tetrahedral elements; groups "x0" ... "z1".
template <Element E>
Mesh<E> box_of(const Vector3& size, std::array<int, 3> cells) {
  if constexpr (E::nodes == 4)
    return read_as<E>(box_tet4(size, cells, BoxSplit::six));
  else if constexpr (E::nodes == 10)
    return read_as<E>(box_tet10(size, cells, BoxSplit::six));
  else if constexpr (E::nodes == 8)
    return read_as<E>(box_hex8(size, cells));
  else
    return read_as<E>(box_hex20(size, cells));
}

/// A grid of the unit cube mapped to another shape: node x is moved to map(x).
template <Element E, class Map>
Mesh<E> mapped_box(std::array<int, 3> cells, Map map) {
  Mesh<E> mesh = box_of<E>({1, 1, 1}, cells);
  for (Vector3& x : mesh.positions) x = map(x);
  return mesh;
}

/// Moves interior corners by up to `amount` per axis; edges of quadratic elements stay straight.
template <Element E>
Mesh<E> jittered(Mesh<E> mesh, double amount, std::uint64_t seed = 1729) {
  testing::Random random(seed);
  std::vector<bool> outside(mesh.positions.size(), false);
  for (const NodeId i : nodes_of(extract_boundary<E>(mesh))) outside[static_cast<std::size_t>(i)] = true;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vector3 step = random.vector<3>(-amount, amount);
    if (!outside[i]) mesh.positions[i] += step;
  }
  if constexpr (QuadraticElement<E>)
    for (const auto& nodes : mesh.elements)
      for (std::size_t i = 0; i < E::edges.size(); ++i) {
        const auto at = [&](std::size_t a) -> Vector3& { return mesh.positions[static_cast<std::size_t>(nodes[a])]; };
        const auto [a, b] = E::edges[i];
        at(E::Linear::nodes + i) = 0.5 * (at(static_cast<std::size_t>(a)) + at(static_cast<std::size_t>(b)));
      }
  return mesh;
}

/// Meshes joined where their nodes coincide (to 1e-9 of `size`). Groups are left out.
template <Element E>
Mesh<E> joined(const std::vector<Mesh<E>>& parts, double size) {
  Mesh<E> whole;
  std::vector<std::pair<std::array<std::int64_t, 3>, NodeId>> keys;
  NodeId next = 0;
  for (const Mesh<E>& part : parts)
    for (const Vector3& x : part.positions)
      keys.push_back(
          {{std::llround(x[0] / size * 1e8), std::llround(x[1] / size * 1e8), std::llround(x[2] / size * 1e8)},
           next++});
  std::ranges::sort(keys);
  std::vector<NodeId> first(keys.size());  // the lowest index at the same position
  for (std::size_t i = 0; i < keys.size(); ++i)
    first[static_cast<std::size_t>(keys[i].second)] = i > 0 && keys[i].first == keys[i - 1].first
                                                          ? first[static_cast<std::size_t>(keys[i - 1].second)]
                                                          : keys[i].second;
  std::vector<NodeId> number(keys.size(), -1);
  NodeId offset = 0;
  for (const Mesh<E>& part : parts) {
    for (NodeId i = 0; i < part.node_count(); ++i) {
      auto& of_first = number[static_cast<std::size_t>(first[static_cast<std::size_t>(offset + i)])];
      if (of_first < 0) {
        of_first = static_cast<NodeId>(whole.positions.size());
        whole.positions.push_back(part.position(i));
      }
      number[static_cast<std::size_t>(offset + i)] = of_first;
    }
    for (auto nodes : part.elements) {
      for (NodeId& node : nodes) node = number[static_cast<std::size_t>(offset + node)];
      whole.elements.push_back(nodes);
    }
    offset += static_cast<NodeId>(part.node_count());
  }
  return whole;
}

/// An eighth of a hollow sphere, x, y, z >= 0: three blocks of n x n cells per side, `layers` through the wall. Groups
/// "x0", "y0", "z0" on the planes, "inner", "outer".
template <Element E>
Mesh<E> sphere_octant(double inner, double outer, int n, int layers) {
  const double quarter = std::numbers::pi / 4.0;
  std::vector<Mesh<E>> blocks;
  for (int axis = 0; axis < 3; ++axis)
    blocks.push_back(mapped_box<E>({layers, n, n}, [&](const Vector3& s) -> Vector3 {
      const Vector3 path = Vector3(1.0, std::tan(quarter * s[1]), std::tan(quarter * s[2])).normalized();
      Vector3 x;
      for (int i = 0; i < 3; ++i) x[(i + axis) % 3] = path[i];
      return (inner + (outer - inner) * s[0]) * x;
    }));
  Mesh<E> mesh = joined(blocks, outer);
  for (Vector3& x : mesh.positions)
    for (double& c : x) c = std::abs(c) < 1e-12 * outer ? 0.0 : c;
  const auto boundary = extract_boundary<E>(mesh);
  const auto add = [&](const char* name, auto on) {
    detail::add_boundary_group(mesh, boundary, name, [&](NodeId i) { return on(mesh.position(i)); });
  };
  add("x0", [](const Vector3& x) { return x[0] == 0.0; });
  add("y0", [](const Vector3& x) { return x[1] == 0.0; });
  add("z0", [](const Vector3& x) { return x[2] == 0.0; });
  add("inner", [&](const Vector3& x) { return std::abs(x.norm() - inner) < 1e-9 * outer; });
  add("outer", [&](const Vector3& x) { return std::abs(x.norm() - outer) < 1e-9 * outer; });
  return mesh;
}

/// Cook's membrane: 48 long, 44 high at the left and 16 at the right, 5 thick; n x n cells, nz through the thickness.
/// Fixed at "x0", loaded at "x1", faces "z0", "z1" [any unit of length].
template <Element E>
Mesh<E> cook_membrane(int n, int nz, double thickness = 5.0) {
  return mapped_box<E>({n, n, nz}, [&](const Vector3& s) -> Vector3 {
    return {48.0 * s[0], 44.0 * s[0] + s[1] * (44.0 - 28.0 * s[0]), thickness * s[2]};
  });
}

/// NAFEMS LE10, a quarter of an elliptic plate: inner ellipse (2, 1) m, outer one (3.25, 2.75) m, 0.6 m thick. Groups
/// "x0" at x = 0, "x1" at y = 0, "y0" on the inner ellipse, "y1" on the outer (the rim), "z1" on top, and
/// "rim_midline". Cells: circumferential, radial, through the thickness (an even number).
template <Element E>
Mesh<E> elliptic_plate(std::array<int, 3> cells) {
  // The angle runs from the y axis to the x axis, so that (angle, outwards, up) is right-handed and volumes are
  // positive.
  const auto at = [](const Vector3& s) -> Vector3 {
    const double angle = 0.5 * std::numbers::pi * (1.0 - s[0]);
    const double c = s[0] == 1.0 ? 1.0 : std::cos(angle), n = s[0] == 1.0 ? 0.0 : std::sin(angle);
    return {(2.0 + 1.25 * s[1]) * (s[0] == 0.0 ? 0.0 : c), (1.0 + 1.75 * s[1]) * n, 0.6 * s[2]};
  };
  Mesh<E> mesh = mapped_box<E>(cells, at);
  Group& midline = mesh.groups.get_or_add("rim_midline", 1);
  for (const NodeId i : mesh.find_group("y1")->nodes)
    if (std::abs(mesh.position(i)[2] - 0.3) < 1e-9) midline.nodes.push_back(i);
  return mesh;
}

/// The node nearest to a point.
template <Element E>
NodeId nearest_node(const Mesh<E>& mesh, const Vector3& point) {
  NodeId best = 0;
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if ((mesh.position(i) - point).squaredNorm() < (mesh.position(best) - point).squaredNorm()) best = i;
  return best;
}

}  // namespace accuracy
