// Stress for drawing: the volume mean of every element, averaged at the nodes. For accurate values at a node see
// post/patch_recovery.hpp.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/post/point_stress.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Equivalent (von Mises) stress [Pa] of every column.
void von_mises(const StressColumns& stress, VectorX& equivalent);

/// The stress of a body, cheap to compute, for drawing. Nodal values are volume-weighted means over the elements around
/// a node: first-order accurate for every element, too low where stress peaks on a surface, and averaged across
/// material interfaces, where the exact stress jumps. The von Mises stress at a node is that of its mean stress.
struct StressField {
  StressColumns elements;      ///< volume mean of every element [Pa]
  StressColumns nodes;         ///< mean around every node [Pa]; zero at a node without elements
  VectorX von_mises_elements;  ///< [Pa]
  VectorX von_mises_nodes;     ///< [Pa]
  VectorX node_volumes;        ///< volume of the elements around every node [m^3], the weights of the mean
};

/// Fills `field` with the stress under the displacement `u` (3 per node [m]). One pass over the elements, about 0.1 us
/// for a linear tetrahedron; no allocation when `field` has the body's sizes, unless the element smooths strain over
/// neighbours. Values of `u` that are not finite give stress that is not finite around them. Throws bad_argument when
/// `u` has a wrong length.
template <Element E>
void recover_stress(const Body<E>& body, const VectorX& u, StressField& field) {
  const Mesh<E>& mesh = body.mesh;
  const detail::ElementStress<E> state(body, u);
  field.elements.resize(6, mesh.element_count());
  field.nodes.setZero(6, mesh.node_count());
  field.node_volumes.setZero(mesh.node_count());
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const detail::MeanStress mean = state.mean(e);
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
/// `model.displacement()`. See recover_stress; this overload allocates.
template <Element E>
StressField stress_field(const Body<E>& body, const VectorX& u) {
  StressField field;
  recover_stress(body, u, field);
  return field;
}

inline void von_mises(const StressColumns& stress, VectorX& equivalent) {
  equivalent.resize(stress.cols());
  for (Index i = 0; i < stress.cols(); ++i) equivalent[i] = voigt::von_mises(stress.col(i));
}

}}  // namespace palpate
