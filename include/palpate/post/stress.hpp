// Stress to draw: the volume mean of every element, smeared over the nodes. For values to trust at a node see
// post/detail/patch_recovery.hpp.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/post/detail/point_stress.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Equivalent (von Mises) stress [Pa] of every column.
void von_mises(const StressColumns& stress, VectorX& equivalent);

/// The stress of a body, cheap and for drawing. Nodal values are means over the elements around a node, weighted by
/// their volumes: of first order whatever the element, too low where stress peaks on a surface, and smeared where two
/// materials meet (the stress itself jumps there). Von Mises at a node is that of its mean stress.
struct StressField {
  StressColumns elements;      ///< volume mean of every element [Pa]
  StressColumns nodes;         ///< mean around every node [Pa]; zero at a node of no element
  VectorX von_mises_elements;  ///< [Pa]
  VectorX von_mises_nodes;     ///< [Pa]
  VectorX node_volumes;        ///< volume of the elements around every node [m^3], the weights of the mean
};

/// Fills `field` with the stress under the displacement `u` (3 per node [m]). One pass over the elements, about 0.1 us
/// for a linear tetrahedron; no allocation when `field` has the body's sizes, unless strain is averaged over
/// neighbours. What is not finite in `u` stays so in the stress around it. Throws bad_argument when `u` has another
/// length.
template <Element E>
void recover_stress(const Body<E>& body, const VectorX& u, StressField& field) {
  const Mesh<E>& mesh = body.mesh;
  const ElementStress<E> state(body, u);
  field.elements.resize(6, mesh.element_count());
  field.nodes.setZero(6, mesh.node_count());
  field.node_volumes.setZero(mesh.node_count());
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const MeanStress mean = state.mean(e);
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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/post/stress.ipp>
#endif
