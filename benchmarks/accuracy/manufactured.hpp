// A manufactured solution: a trigonometric displacement and the corresponding body force.
#pragma once

#include "meshes.hpp"
#include "statics.hpp"

#include <palpate/post/point_stress.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/quadrature/simplex.hpp>

namespace accuracy {

/// u_c = a_c cos(k_c . x + phi_c). It is not zero on the boundary, so boundary values are prescribed too.
struct Manufactured {
  LinearElastic material{.youngs_modulus = 1.0, .poisson_ratio = 0.3};
  Vector3 amplitude{1.0, -0.5, 0.7}, phase{0.3, 1.1, -0.4};
  Matrix3 waves = (Matrix3() << 2.0, 1.0, 0.5, -0.7, 2.5, 1.0, 1.2, -0.6, 2.2).finished();  ///< k_c per row [1/m]

  Vector3 displacement(const Vector3& x) const {
    return amplitude.cwiseProduct(Vector3((waves * x + phase).array().cos()));
  }
  Vector6 strain(const Vector3& x) const {
    const Vector3 slope = -amplitude.cwiseProduct(Vector3((waves * x + phase).array().sin()));
    const Matrix3 gradient = slope.asDiagonal() * waves;
    return voigt::strain_vector(0.5 * (gradient + gradient.transpose()));
  }
  /// -div sigma = -(mu lap u + (lambda + mu) grad div u) [N/m^3].
  Vector3 body_force(const Vector3& x) const {
    const Vector3 u = displacement(x);  // second derivatives: u_c,ij = -k_ci k_cj u_c
    const Vector3 laplacian = -u.cwiseProduct(waves.rowwise().squaredNorm());
    const Vector3 gradient_of_divergence = -waves.transpose() * u.cwiseProduct(waves.diagonal());
    return -(material.shear_modulus() * laplacian +
             (material.lame_lambda() + material.shear_modulus()) * gradient_of_divergence);
  }
};

/// A quadrature rule of higher degree than that of the element, for loads and errors.
template <Element E>
using FineRule = std::conditional_t<E::faces.size() == 4, TetrahedronRule<5>, HexahedronRule<4>>;

/// Relative errors of displacement (L2) and strain (energy norm).
struct Errors {
  double displacement = 0.0, energy = 0.0;
};

template <Element E>
VectorX consistent_load(const Mesh<E>& mesh, const Manufactured& field) {
  VectorX load = VectorX::Zero(3 * mesh.node_count());
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(mesh, e);
    for (const auto& point : FineRule<E>::points) {
      const Vector3 xi = detail::reference_point(point);
      const auto shape = E::shape(xi);
      const Vector3 force =
          detail::point_geometry<E>(x, xi, point.weight).volume * field.body_force(x.transpose() * shape);
      for (int a = 0; a < E::nodes; ++a) load.segment<3>(3 * Index{mesh.element_node(e, a)}) += shape[a] * force;
    }
  }
  return load;
}

template <Element E>
Errors errors_of(const Body<E>& body, const VectorX& u, const Manufactured& field) {
  double missed = 0.0, whole = 0.0, missed_energy = 0.0, energy = 0.0;
  const Matrix6& d = body.elasticity.front();
  const detail::ElementStress<E> state(body, u);
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const ElementNodes<E> moved = detail::element_displacements<E>(body.mesh, e, u);
    const auto points = state.template points<FineRule<E>>(e);
    for (std::size_t q = 0; q < points.size(); ++q) {
      const auto& point = points[q];
      const Vector3 exact = field.displacement(point.position);
      const Vector3 found = moved.transpose() * E::shape(detail::reference_point(FineRule<E>::points[q]));
      const Vector6 strain = field.strain(point.position), difference = point.strain - strain;
      missed += point.volume * (found - exact).squaredNorm();
      whole += point.volume * exact.squaredNorm();
      missed_energy += point.volume * difference.dot(d * difference);
      energy += point.volume * strain.dot(d * strain);
    }
  }
  return {std::sqrt(missed / whole), std::sqrt(missed_energy / energy)};
}

/// Solves on a mesh with exact values on the whole boundary; `solve` is solve_static or has the same interface.
template <Element E, class Solve>
Errors manufactured_errors(Mesh<E> mesh, const Manufactured& field, Solve solve) {
  Scene scene;
  for (const NodeId i : nodes_of(extract_boundary<E>(mesh))) {
    const Vector3 u = field.displacement(mesh.position(i));
    scene.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  const Body<E> body = body_of(std::move(mesh), {field.material});
  return errors_of(body, solve(body, scene, consistent_load(body.mesh, field)).displacement, field);
}

/// A unit cube of n^3 cells, with inner corners moved by up to a tenth of a cell if `distorted`.
template <Element E>
Mesh<E> refined_cube(int n, bool distorted) {
  Mesh<E> mesh = box_of<E>({1, 1, 1}, {n, n, n});
  return distorted ? jittered(std::move(mesh), 0.1 / n) : mesh;
}

/// A priori orders of the displacement in L2 and of the energy. Serendipity elements that are not parallelepipeds
/// reproduce only linear fields (Arnold, Boffi and Falk 2002), so Hex20 may drop to first order on distorted meshes.
template <Element E>
std::pair<double, double> theoretical_orders(bool distorted) {
  const int order = distorted && E::nodes == 20 ? 1 : E::order;
  return {order + 1.0, order};
}

inline double observed_order(double coarse, double fine, double refinement) {
  return std::log(coarse / fine) / std::log(refinement);
}

}  // namespace accuracy
