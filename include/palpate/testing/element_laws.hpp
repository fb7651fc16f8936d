// The laws of concepts/element.hpp. Face laws are in face_laws.hpp.
#pragma once

#include <palpate/testing/face_laws.hpp>
#include <palpate/testing/quadrature_laws.hpp>

namespace palpate::inline PALPATE_ABI::testing {

/// Laws of a surface element: the shape laws, linear completeness, the laws of its rule on its own reference cell, and
/// "rule integrates the shape functions" (a constant traction gives the consistent load).
template <FaceElement F>
Violations face_element_laws() {
  Violations v = basic_shape_laws<F, 2>();
  Worst linear("linear completeness", 1e-12), load("rule integrates the shape functions", 1e-13);
  const auto points = sample_points<F::nodes, 2>(F::reference_nodes());
  for (const auto& p : exponents<2>(1))
    if (total_degree(p) <= 1) linear.see(interpolation_error<F, 2>(points, p), [] { return std::string("1, u or v"); });
  linear.report(v);

  const auto cell = cell_of<F>();
  expect_true(v, "reference cell", cell.has_value(), "the corners make no triangle and no box");
  if (!cell) return v;
  append(v, quadrature_laws<typename F::Quadrature>(*cell), "Quadrature");
  Eigen::Matrix<double, F::nodes, 1> by_rule = Eigen::Matrix<double, F::nodes, 1>::Zero();
  for (const auto& q : F::Quadrature::points) by_rule += q.weight * F::shape(point_of(q.xi));
  for (int a = 0; a < F::nodes; ++a) {
    const double exact = integrate(*cell, [a](const Point<2>& xi) { return F::shape(xi)[a]; });
    load.see(std::abs(by_rule[a] - exact), [a] { return "node " + std::to_string(a); });
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
      products.see(std::abs(by_rule - integrate(cell, product)),
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
  expect_true(v, "face nodes in range", face_nodes_in_range<E>());
  if (!face_nodes_in_range<E>()) return v;
  append(v, face_laws<E>());
  const auto cell = cell_of<E>();
  expect_true(v, "reference cell", cell.has_value(), "nodes on three faces make no tetrahedron and no box");
  if (!cell) return v;
  append(v, volume_laws<E>(*cell));
  append(v, numbering_laws<E>(cell->domain));
  append(v, quadrature_laws<typename E::Quadrature>(*cell), "Quadrature");
  append(v, quadrature_laws<typename E::MassQuadrature>(*cell), "MassQuadrature");
  append(v, rule_choice_laws<E>(*cell));
  return v;
}

}  // namespace palpate::inline PALPATE_ABI::testing
