// Strain and stress at points of one element, and their mean.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/integration_points.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/mesh/mesh.hpp>

#include <array>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// One stress per column [Pa], Voigt order of core/voigt.hpp.
using StressColumns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Stress [Pa] at the reference point `xi` of an element: sigma = D (epsilon - epsilon_0) (thesis 3.24, with the
/// initial strain of 3.1). `x` contains the nodes [m] and `u` their displacements [m], one per row; `d` is the
/// elasticity matrix [Pa].
template <Element E>
Vector6 point_stress(const ElementNodes<E>& x, const ElementNodes<E>& u, const Vector3& xi, const Matrix6& d,
                     const Vector6& strain0 = Vector6::Zero()) noexcept {
  return d * (detail::strain_at<E>(detail::integration_point<E>(x, xi, 1.0), u) - strain0);
}

namespace detail {

/// The mean of an element's stress over its volume.
struct MeanStress {
  Vector6 stress = Vector6::Zero();  ///< [Pa]
  double volume = 0.0;               ///< of the undeformed element [m^3]
};

/// Mean stress of an element with its own quadrature; exact where `point_stress` is. Linear tetrahedra have constant
/// stress.
template <Element E>
MeanStress mean_stress(const ElementNodes<E>& x, const ElementNodes<E>& u, const Matrix6& d,
                       const Vector6& strain0 = Vector6::Zero()) noexcept {
  MeanStress mean;
  Vector6 sum = Vector6::Zero();
  for (const IntegrationPoint<E>& point : integration_points<E>(x)) {
    sum += point.volume * strain_at<E>(point, u);
    mean.volume += point.volume;
  }
  mean.stress.noalias() = d * (sum / mean.volume - strain0);
  return mean;
}

/// Strain and stress of a body at one point.
struct StressPoint {
  Vector3 position = Vector3::Zero();  ///< undeformed [m]
  Vector6 strain = Vector6::Zero();    ///< total strain, including initial strain
  Vector6 stress = Vector6::Zero();    ///< [Pa]
  double volume = 0.0;                 ///< quadrature volume of the point [m^3]
};

/// Displacements of an element's nodes, one per row [m], from those of all nodes (3 per node).
template <Element E>
ElementNodes<E> element_displacements(const Mesh<E>& mesh, Index e, const VectorX& u) noexcept {
  ElementNodes<E> rows;
  for (int a = 0; a < E::nodes; ++a)
    rows.row(a) = u.template segment<3>(3 * Index{mesh.element_node(e, a)}).transpose();
  return rows;
}

/// Throws bad_argument when a displacement does not have three numbers per node.
template <Element E>
void require_displacement(const Mesh<E>& mesh, const VectorX& u) {
  if (u.size() != 3 * mesh.node_count())
    raise(SetupErrorKind::bad_argument,
          "a displacement of " + std::to_string(u.size()) + " numbers for " + std::to_string(mesh.node_count()) +
              " nodes",
          "Give three per node");
}

/// Strain and stress in the elements of a body under the displacement `u` (3 per node [m]). The strain is that of the
/// element formulation: for mean-dilatation elements with the mean change of volume; for smoothed elements
/// (element/wrappers.hpp) the average over neighbours, constant in every element and computed for all elements by the
/// constructor. Keeps references to body and displacement.
template <Element E>
class ElementStress {
 public:
  /// Throws bad_argument when `u` does not have three numbers per node.
  ElementStress(const Body<E>& body, const VectorX& u) : body_(body), u_(u) {
    require_displacement(body.mesh, u);
    if constexpr (HasSmoothedStrain<E>) smoothed_ = smoothed_state(body, u);
  }

  /// State at the points of the element's own quadrature, or of another rule. No allocation; 0.1 us (Tet4) to 25 us
  /// (Hex20).
  template <Quadrature Rule = typename E::Quadrature>
  std::array<StressPoint, Rule::points.size()> points(Index e) const noexcept {
    const ElementNodes<E> x = element_nodes<E>(body_.mesh, e);
    const ElementNodes<E> moved = element_displacements<E>(body_.mesh, e, u_);
    IntegrationPoint<E> at;
    if constexpr (HasMeanDilatation<E>) at.dilatation = mean_gradient<E>(x);
    std::array<StressPoint, Rule::points.size()> points;
    for (std::size_t q = 0; q < points.size(); ++q) {
      const Vector3 xi = reference_point(Rule::points[q]);
      static_cast<PointGeometry<E>&>(at) = point_geometry<E>(x, xi, Rule::points[q].weight);
      points[q] = {x.transpose() * E::shape(xi), Vector6::Zero(), Vector6::Zero(), at.volume};
      if constexpr (HasSmoothedStrain<E>) {
        points[q].strain = smoothed_.strain.col(e);
        points[q].stress = smoothed_.stress.col(e);
      } else {
        points[q].strain = strain_at<E>(at, moved);
        points[q].stress = body_.elasticity_of(e) * (points[q].strain - body_.initial_strain[body_.region_of(e)]);
      }
    }
    return points;
  }

  /// The mean over an element.
  MeanStress mean(Index e) const noexcept {
    const ElementNodes<E> x = element_nodes<E>(body_.mesh, e);
    if constexpr (HasSmoothedStrain<E>)
      return {smoothed_.stress.col(e), shape_volumes<E>(x).sum()};
    else
      return mean_stress<E>(x, element_displacements<E>(body_.mesh, e, u_), body_.elasticity_of(e),
                            body_.initial_strain[body_.region_of(e)]);
  }

 private:
  struct Nothing {};
  const Body<E>& body_;
  const VectorX& u_;
  [[no_unique_address]] std::conditional_t<HasSmoothedStrain<E>, SmoothedState, Nothing> smoothed_;
};

}  // namespace detail

}}  // namespace palpate
