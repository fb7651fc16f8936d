// Estimate of the discretisation error of the stress, and of where the mesh is too coarse.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/detail/serendipity.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/post/patch_recovery.hpp>
#include <palpate/post/point_stress.hpp>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Estimate of the discretisation error in the energy norm |e| = (integral of e_sigma : D^-1 : e_sigma)^1/2, the square
/// root of twice its strain energy [J^1/2].
struct ErrorEstimate {
  VectorX elements;          ///< of every element [J^1/2]; the sum of their squares is the square of `error`
  double error = 0.0;        ///< of the body [J^1/2]
  double energy_norm = 0.0;  ///< of the computed elastic strain, sqrt(2 strain energy) [J^1/2]
  int order = 1;             ///< of the element

  /// Error over the norm of the estimated exact solution, 0 ... 1; 0 for an unloaded body.
  double relative() const noexcept;

  /// h_new / h per element for a mesh whose relative error is `target`, spread evenly over the elements (Zienkiewicz
  /// and Zhu 1987): below 1 the mesh is too coarse there, above 1 finer than necessary. Clamped to 1 / `most` ...
  /// `most`. Next to a singular point the error converges more slowly than the order of the element: refine in steps,
  /// and estimate again. Throws bad_argument unless 0 < target < 1 and most >= 1.
  VectorX size_ratio(double target, double most = 8.0) const;
};

namespace detail {
/// Inverses. Not a template: Eigen's decompositions take seconds to compile.
std::vector<Matrix6> compliances_of(const std::vector<Matrix6>& elasticities);
}  // namespace detail

/// The estimate of Zienkiewicz and Zhu (1987, 1992): the recovered stress, interpolated with the shape functions,
/// replaces the exact one. `nodal` is patch_recovery of the same body and displacement. Valid where the mesh resolves
/// the solution: there the ratio of estimated to true error tends to 1. It cannot detect features that the whole mesh
/// does not resolve; a body that locks (plain Tet4 or Hex8 near nu = 0.5) has a larger error than estimated. Costs 1 us
/// (Tet4) to 35 us (Hex20) per element. Throws bad_argument when `u` or `nodal` do not fit the body.
template <Element E>
ErrorEstimate estimate_error(const Body<E>& body, const VectorX& u, const NodalStress& nodal) {
  const detail::ElementStress<E> state(body, u);
  if (nodal.first.size() != static_cast<std::size_t>(body.mesh.node_count()) + 1)
    raise(SetupErrorKind::bad_argument, "the recovered stress belongs to another mesh", "Give patch_recovery(body, u)");
  const std::vector<Matrix6> compliances = detail::compliances_of(body.elasticity);
  ErrorEstimate estimate{VectorX(body.mesh.element_count()), 0.0, 0.0, E::order};
  double error = 0.0, energy = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    Eigen::Matrix<double, 6, E::nodes> at_nodes;
    for (int a = 0; a < E::nodes; ++a)
      at_nodes.col(a) = nodal.stress.col(nodal.column(body.mesh.element_node(e, a), body.mesh.region(e)));
    const Matrix6& compliance = compliances[body.material_of(e)];
    const auto points = state.template points<typename E::MassQuadrature>(e);
    double square = 0.0;
    for (std::size_t q = 0; q < points.size(); ++q) {
      const Vector6 missed =
          at_nodes * E::shape(detail::reference_point(E::MassQuadrature::points[q])) - points[q].stress;
      square += points[q].volume * missed.dot(compliance * missed);
      energy += points[q].volume * points[q].stress.dot(compliance * points[q].stress);
    }
    estimate.elements[e] = std::sqrt(square);
    error += square;
  }
  estimate.error = std::sqrt(error);
  estimate.energy_norm = std::sqrt(energy);
  return estimate;
}

/// The same; recovers the stress first.
template <Element E>
ErrorEstimate estimate_error(const Body<E>& body, const VectorX& u) {
  return estimate_error(body, u, patch_recovery(body, u));
}

inline double ErrorEstimate::relative() const noexcept {
  const double whole = std::hypot(error, energy_norm);
  return whole > 0.0 ? error / whole : 0.0;
}

inline VectorX ErrorEstimate::size_ratio(double target, double most) const {
  if (!(target > 0.0 && target < 1.0) || !(most >= 1.0))
    raise(SetupErrorKind::bad_argument, "a mesh for a relative error of " + number(target),
          "Give a target between 0 and 1");
  const double allowed =
      target * std::hypot(error, energy_norm) / std::sqrt(static_cast<double>(std::max<Index>(elements.size(), 1)));
  VectorX ratio(elements.size());
  for (Index e = 0; e < ratio.size(); ++e)
    if (elements[e] == 0.0)
      ratio[e] = most;
    else
      ratio[e] = std::clamp(std::pow(allowed / elements[e], 1.0 / order), 1.0 / most, most);  // NaN stays NaN
  return ratio;
}

namespace detail {

inline std::vector<Matrix6> compliances_of(const std::vector<Matrix6>& elasticities) {
  std::vector<Matrix6> inverses;
  inverses.reserve(elasticities.size());
  for (const Matrix6& d : elasticities) inverses.push_back(d.ldlt().solve(Matrix6::Identity()));
  return inverses;
}

}  // namespace detail

}}  // namespace palpate
