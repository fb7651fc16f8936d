// Strain and stress in points of one element, and their mean.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/local/integration_points.hpp>

namespace palpate::inline PALPATE_ABI {

/// One stress per column [Pa], Voigt order of core/voigt.hpp.
using StressColumns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Stress [Pa] in the reference point `xi` of an element: sigma = D (epsilon - epsilon_0) (thesis 3.24, with the
/// initial strain of 3.1). `x` holds the nodes [m], `u` their displacements [m], one per row; `d` the elasticity matrix
/// [Pa].
template <Element E>
Vector6 point_stress(const ElementNodes<E>& x, const ElementNodes<E>& u, const Vector3& xi, const Matrix6& d,
                     const Vector6& strain0 = Vector6::Zero()) noexcept {
  return d * (strain_at<E>(integration_point<E>(x, xi, 1.0), u) - strain0);
}

/// The mean of an element's stress over its volume.
struct MeanStress {
  Vector6 stress = Vector6::Zero();  ///< [Pa]
  double volume = 0.0;               ///< of the undeformed element [m^3]
};

/// Mean stress of an element with its own rule; exact where `point_stress` is, for linear tetrahedra constant.
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

/// State of a body in one point.
struct StressPoint {
  Vector3 position = Vector3::Zero();  ///< undeformed [m]
  Vector6 strain = Vector6::Zero();    ///< whole strain, initial strain included
  Vector6 stress = Vector6::Zero();    ///< [Pa]
  double volume = 0.0;                 ///< the point stands for [m^3]
};

/// Displacements of an element's nodes, one per row [m], from those of all nodes (3 per node).
template <Element E>
ElementNodes<E> element_displacements(const Mesh<E>& mesh, Index e, const VectorX& u) noexcept {
  ElementNodes<E> rows;
  for (int a = 0; a < E::nodes; ++a)
    rows.row(a) = u.template segment<3>(3 * Index{mesh.element_node(e, a)}).transpose();
  return rows;
}

/// Strain and stress of element e in the points of its own rule, or of another one, under the displacement `u` (3 per
/// node [m]). The strain is that of the element: with a mean change of volume, its own. No allocation; 0.1 us (Tet4) to
/// 25 us (Hex20).
template <Element E, Quadrature Rule = typename E::Quadrature>
std::array<StressPoint, Rule::points.size()> stress_points(const Body<E>& body, Index e, const VectorX& u) noexcept {
  const ElementNodes<E> x = element_nodes<E>(body.mesh, e), moved = element_displacements<E>(body.mesh, e, u);
  IntegrationPoint<E> at;
  if constexpr (HasMeanDilatation<E>) at.dilatation = mean_gradient<E>(x);
  std::array<StressPoint, Rule::points.size()> points;
  for (std::size_t q = 0; q < points.size(); ++q) {
    const Vector3 xi = reference_point(Rule::points[q]);
    static_cast<PointGeometry<E>&>(at) = point_geometry<E>(x, xi, Rule::points[q].weight);
    const Vector6 strain = strain_at<E>(at, moved);
    points[q] = {x.transpose() * E::shape(xi), strain,
                 body.elasticity_of(e) * (strain - body.initial_strain[body.region_of(e)]), at.volume};
  }
  return points;
}

/// Refuses (bad_argument) a displacement that has not three numbers per node.
template <Element E>
void require_displacement(const Mesh<E>& mesh, const VectorX& u) {
  if (u.size() != 3 * mesh.node_count())
    raise(SetupErrorKind::bad_argument,
          "a displacement of " + std::to_string(u.size()) + " numbers for " + std::to_string(mesh.node_count()) +
              " nodes",
          "Give three per node");
}

}  // namespace palpate::inline PALPATE_ABI
