// Stress from displacement: in a point, as an element's mean, and smoothed to the nodes.
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

/// Equivalent (von Mises) stress [Pa] of every column.
inline void von_mises(const StressColumns& stress, VectorX& equivalent) {
  equivalent.resize(stress.cols());
  for (Index i = 0; i < stress.cols(); ++i) equivalent[i] = voigt::von_mises(stress.col(i));
}

/// The stress of a body. Nodal values are means over the elements around a node, weighted by their volumes: smooth
/// enough to draw, but smeared where two materials meet (the stress itself jumps there). Von Mises at a node is that of
/// its mean stress.
struct StressField {
  StressColumns elements;      ///< volume mean of every element [Pa]
  StressColumns nodes;         ///< recovered at every node [Pa]; zero at a node of no element
  VectorX von_mises_elements;  ///< [Pa]
  VectorX von_mises_nodes;     ///< [Pa]
  VectorX node_volumes;        ///< volume of the elements around every node [m^3], the weights of the mean
};

/// Fills `field` with the stress under the displacement `u` (3 per node [m]). One pass over the elements, about 0.1 us
/// for a linear tetrahedron; no allocation when `field` has the body's sizes. What is not finite in `u` stays so in the
/// stress around it. Throws bad_argument when `u` has another length.
template <Element E>
void recover_stress(const Body<E>& body, const VectorX& u, StressField& field) {
  const Mesh<E>& mesh = body.mesh;
  if (u.size() != 3 * mesh.node_count())
    raise(SetupErrorKind::bad_argument,
          "a displacement of " + std::to_string(u.size()) + " numbers for " + std::to_string(mesh.node_count()) +
              " nodes",
          "Give three per node");
  field.elements.resize(6, mesh.element_count());
  field.nodes.setZero(6, mesh.node_count());
  field.node_volumes.setZero(mesh.node_count());
  for (Index e = 0; e < mesh.element_count(); ++e) {
    ElementNodes<E> moved;
    for (int a = 0; a < E::nodes; ++a) moved.row(a) = u.template segment<3>(3 * Index{mesh.element_node(e, a)});
    const MeanStress mean =
        mean_stress<E>(element_nodes<E>(mesh, e), moved, body.elasticity_of(e), body.initial_strain[body.region_of(e)]);
    field.elements.col(e) = mean.stress;
    for (int a = 0; a < E::nodes; ++a) {
      field.nodes.col(mesh.element_node(e, a)) += mean.volume * mean.stress;
      field.node_volumes[mesh.element_node(e, a)] += mean.volume;
    }
  }
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (field.node_volumes[i] > 0.0) field.nodes.col(i) /= field.node_volumes[i];
  von_mises(field.elements, field.von_mises_elements);
  von_mises(field.nodes, field.von_mises_nodes);
}

/// The stress of a body under the displacement `u` (3 per node [m]), for instance `model.body()` and
/// `model.displacement()`. See recover_stress; this one allocates.
template <Element E>
StressField stress_field(const Body<E>& body, const VectorX& u) {
  StressField field;
  recover_stress(body, u, field);
  return field;
}

}  // namespace palpate::inline PALPATE_ABI
