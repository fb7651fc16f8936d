// The laws of concepts/element.hpp. Face laws are in face_laws.hpp.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/face_laws.hpp>
#include <palpate/testing/quadrature_laws.hpp>
#include <palpate/testing/reference_cell.hpp>
#include <palpate/testing/shape_laws.hpp>
#include <palpate/testing/violation.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// True when every face lists nodes the element has.
template <Element E>
bool face_nodes_in_range() {
  for (std::size_t f = 0; f < E::faces.size(); ++f)
    for (int a : palpate::detail::local_face<E>(f))
      if (a < 0 || a >= E::nodes) return false;
  return true;
}

/// Local numbers of the corners in ascending order: nodes on three faces or more (mid-edge nodes are on two).
template <Element E>
std::vector<int> corners_of() {
  std::vector<int> corners;
  for (int a = 0; a < E::nodes; ++a) {
    std::size_t count = 0;
    for (const auto& face : E::faces) count += std::ranges::count(face, a) > 0 ? 1 : 0;
    if (count >= 3) corners.push_back(a);
  }
  return corners;
}

/// The cell with these corners: Dim + 1 corners form a simplex, 2^Dim an axis-aligned box; std::nullopt for anything
/// else.
template <int Dim>
std::optional<ReferenceCell<Dim>> cell_with_corners(const std::vector<Point<Dim>>& corners) {
  if (corners.size() == static_cast<std::size_t>(Dim + 1)) {
    ReferenceCell<Dim> cell{Dim == 2 ? Domain::triangle : Domain::tetrahedron, corners[0]};
    for (int i = 0; i < Dim; ++i) cell.axes.col(i) = corners[static_cast<std::size_t>(i + 1)] - corners[0];
    return cell;
  }
  if (corners.size() != std::size_t{1} << Dim) return std::nullopt;
  Point<Dim> low = corners[0], high = corners[0];
  for (const auto& c : corners) {
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  ReferenceCell<Dim> cell{Dim == 2 ? Domain::quadrilateral : Domain::hexahedron, 0.5 * (low + high)};
  cell.axes = Point<Dim>(0.5 * (high - low)).asDiagonal();
  for (const auto& c : corners)
    if (!((cell.to_standard(c).cwiseAbs().array() - 1.0).abs().maxCoeff() < 1e-12)) return std::nullopt;
  return cell;
}

/// Reference cell of a solid element: a tetrahedron or a box.
template <Element E>
std::optional<ReferenceCell<3>> cell_of() {
  std::vector<Point<3>> corners;
  const ElementNodes<E> x = E::reference_nodes();
  for (int a : corners_of<E>()) corners.push_back(x.row(a).transpose());
  return cell_with_corners<3>(corners);
}

/// Reference cell of a surface element. A corner is a node from which all others are within an angle of less than pi.
template <FaceElement F>
std::optional<ReferenceCell<2>> cell_of() {
  const Eigen::Matrix<double, F::nodes, 2> x = F::reference_nodes();
  const Vector2 centre = x.colwise().mean().transpose();
  std::vector<Point<2>> corners;
  for (int a = 0; a < F::nodes; ++a) {
    const Vector2 p = x.row(a).transpose();
    const Vector2 inward = centre - p;
    double left = 0.0, right = 0.0;
    for (int b = 0; b < F::nodes; ++b) {
      if (b == a) continue;
      const Vector2 to = x.row(b).transpose() - p;
      const double angle = std::atan2(inward[0] * to[1] - inward[1] * to[0], inward.dot(to));
      left = std::max(left, angle);
      right = std::min(right, angle);
    }
    if (inward.norm() > 0.0 && left - right < 3.14159) corners.push_back(p);
  }
  return cell_with_corners<2>(corners);
}

/// Laws of the triangles of a face: "triangles name nodes of the face", "triangles have the orientation of the face",
/// "triangles cover the face" (their areas sum to its own), "every node is a vertex of a triangle, and is in no other".
template <TriangulatedFace F>
Violations triangulation_laws(double area) {
  Violations v;
  const Eigen::Matrix<double, F::nodes, 2> x = F::reference_nodes();
  const auto area_of = [](const Vector2& a, const Vector2& b, const Vector2& c) {
    return 0.5 * ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]);
  };
  double sum = 0.0;
  std::vector<bool> used(static_cast<std::size_t>(F::nodes), false);
  for (const auto& t : F::triangles) {
    const bool in_range = std::ranges::all_of(t, [](int a) { return a >= 0 && a < F::nodes; });
    expect_true(v, "triangles name nodes of the face", in_range);
    if (!in_range) return v;
    const std::array<Vector2, 3> p{x.row(t[0]).transpose(), x.row(t[1]).transpose(), x.row(t[2]).transpose()};
    const double own = area_of(p[0], p[1], p[2]);
    expect_above(v, "triangles have the orientation of the face", own, 0.0);
    sum += own;
    for (int a : t) used[static_cast<std::size_t>(a)] = true;
    for (int a = 0; a < F::nodes; ++a) {
      if (std::ranges::find(t, a) != t.end()) continue;
      const Vector2 q = x.row(a).transpose();
      const double inside = std::min({area_of(q, p[1], p[2]), area_of(p[0], q, p[2]), area_of(p[0], p[1], q)});
      expect_true(v, "every node is a vertex of a triangle, and is in no other", inside < -1e-9 * own,
                  "node " + std::to_string(a));
    }
  }
  expect_at_most(v, "triangles cover the face", std::abs(sum - area), 1e-12 * area);
  expect_true(v, "every node is a vertex of a triangle, and is in no other",
              std::ranges::find(used, false) == used.end());
  return v;
}

/// Laws of a surface element: the shape laws, linear completeness, the laws of its rule on its own reference cell, and
/// "rule integrates the shape functions" (a constant traction gives the consistent load),
/// and those of its triangles where it has any.
template <FaceElement F>
Violations face_element_laws() {
  Violations v = basic_shape_laws<F, 2>();
  Worst linear("linear completeness", 1e-12), load("rule integrates the shape functions", 1e-13);
  const auto points = sample_points<F::nodes, 2>(F::reference_nodes());
  for (const auto& p : exponents<2>(1))
    if (total_degree(p) <= 1)
      linear.observe(interpolation_error<F, 2>(points, p), [] { return std::string("1, u or v"); });
  linear.report(v);

  const auto cell = cell_of<F>();
  expect_true(v, "reference cell", cell.has_value(), "the corners form neither a triangle nor a box");
  if (!cell) return v;
  append(v, quadrature_laws<typename F::Quadrature>(*cell), "Quadrature");
  if constexpr (TriangulatedFace<F>) append(v, triangulation_laws<F>(cell->volume()), "triangles");
  Eigen::Matrix<double, F::nodes, 1> by_rule = Eigen::Matrix<double, F::nodes, 1>::Zero();
  for (const auto& q : F::Quadrature::points) by_rule += q.weight * F::shape(point_of(q.xi));
  for (int a = 0; a < F::nodes; ++a) {
    const double exact = integrate(*cell, [a](const Point<2>& xi) { return F::shape(xi)[a]; });
    load.observe(std::abs(by_rule[a] - exact), [a] { return "node " + std::to_string(a); });
  }
  load.report(v);
  return v;
}

/// "reference volume": the stated one, that of the corners and the weight sums of both rules agree.
template <Element E>
Violations volume_laws(const ReferenceCell<3>& cell) {
  Violations v;
  const double volume = E::reference_volume, bound = 1e-13 * cell.volume();
  expect_at_most(v, "reference volume", std::abs(volume - cell.volume()), bound, "stated against that of the corners");
  expect_at_most(v, "reference volume", std::abs(weight_sum<typename E::Quadrature>() - cell.volume()), bound,
                 "weights of Quadrature");
  expect_at_most(v, "reference volume", std::abs(weight_sum<typename E::MassQuadrature>() - cell.volume()), bound,
                 "weights of MassQuadrature");
  return v;
}

/// "right-handed numbering": corners 0, 1, 2, 3 of a tetrahedron and 0, 1, 3, 4 of a hexahedron span a positive volume,
/// as in meshes.
template <Element E>
Violations numbering_laws(Domain domain) {
  Violations v;
  const auto c = corners_of<E>();
  const ElementNodes<E> x = E::reference_nodes();
  const int last = domain == Domain::tetrahedron ? c[3] : c[4], third = domain == Domain::tetrahedron ? c[2] : c[3];
  const Vector3 a = (x.row(c[1]) - x.row(c[0])).transpose(), b = (x.row(third) - x.row(c[0])).transpose();
  const Vector3 d = (x.row(last) - x.row(c[0])).transpose();
  expect_above(v, "right-handed numbering", cross(a, b).dot(d), 0.0);
  return v;
}

/// "MassQuadrature exact for products" of two shape functions; "degree of Quadrature": at least 2 (order - 1), what the
/// stiffness of a straight-sided element needs to converge.
template <Element E>
Violations rule_choice_laws(const ReferenceCell<3>& cell) {
  Violations v;
  Worst products("MassQuadrature exact for products", 1e-13 * cell.volume());
  for (int a = 0; a < E::nodes; ++a)
    for (int b = 0; b <= a; ++b) {
      const auto product = [a, b](const Point<3>& xi) { return E::shape(xi)[a] * E::shape(xi)[b]; };
      double by_rule = 0.0;
      for (const auto& q : E::MassQuadrature::points) by_rule += q.weight * product(point_of(q.xi));
      products.observe(std::abs(by_rule - integrate(cell, product)),
                       [a, b] { return "functions " + std::to_string(a) + " and " + std::to_string(b); });
    }
  products.report(v);
  expect_at_least(v, "degree of Quadrature", E::Quadrature::degree, 2.0 * (E::order - 1));
  return v;
}

/// All laws of a solid element, its faces, its face element and its rules. Reference domains: any tetrahedron, any box
/// along the axes.
template <Element E>
Violations element_laws() {
  static_assert(E::MassQuadrature::dimension == 3,
                "palpate: MassQuadrature of a solid element needs points with three coordinates");
  Violations v = basic_shape_laws<E, 3>();
  append(v, completeness_laws<E, 3>(E::order));
  append(v, face_element_laws<typename E::Face>(), "Face");
  if constexpr (HasSmallFace<E>) append(v, face_element_laws<typename E::SmallFace>(), "SmallFace");
  expect_true(v, "face nodes in range", face_nodes_in_range<E>());
  if (!face_nodes_in_range<E>()) return v;
  append(v, face_laws<E>());
  const auto cell = cell_of<E>();
  expect_true(v, "reference cell", cell.has_value(), "nodes on three faces form neither a tetrahedron nor a box");
  if (!cell) return v;
  append(v, volume_laws<E>(*cell));
  append(v, numbering_laws<E>(cell->domain));
  append(v, quadrature_laws<typename E::Quadrature>(*cell), "Quadrature");
  append(v, quadrature_laws<typename E::MassQuadrature>(*cell), "MassQuadrature");
  append(v, rule_choice_laws<E>(*cell));
  return v;
}

}}}  // namespace palpate::testing
