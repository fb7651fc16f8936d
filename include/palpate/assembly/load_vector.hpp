// Nodal loads of a whole scene (thesis 3.38, 3.47; BCNaturlig, EksternLast, InitToyning).
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/smoothed_strain.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/integration_points.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Coordinates of a boundary face's nodes, one per row [m].
template <FaceElement F, Element E>
FaceNodes<F> face_nodes(const Mesh<E>& mesh, const BoundaryFace<E>& face) {
  FaceNodes<F> x;
  for (int a = 0; a < F::nodes; ++a)
    x.row(a) = mesh.position(Index{face.nodes[static_cast<std::size_t>(a)]}).transpose();
  return x;
}

/// Mass per node [kg] by row sums: the consistent load of a uniform acceleration g is mass times g (3.44). One entry
/// per node.
template <Element E>
VectorX nodal_mass(const Body<E>& body) {
  VectorX mass = VectorX::Zero(body.mesh.node_count());
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto v = shape_volumes<E>(element_nodes<E>(body.mesh, e));
    for (int a = 0; a < E::nodes; ++a) mass[body.mesh.element_node(e, a)] += body.density[body.region_of(e)] * v[a];
  }
  return mass;
}

/// Tractions, pressures, point loads and body loads of a scene, gravity excepted: 3 nodes entries [N]. Throws
/// unknown_group, empty_group or unsupported (a load on an inner face).
template <Element E>
VectorX applied_load(const Body<E>& body, const std::vector<BoundaryFace<E>>& boundary, const Scene& scene) {
  const Mesh<E>& mesh = body.mesh;
  VectorX f = VectorX::Zero(3 * mesh.node_count());
  const auto add = [&](NodeId node, const Vector3& force) { f.template segment<3>(3 * Index{node}) += force; };

  for (const auto& load : scene.tractions())
    for (const auto& face : resolve_faces(mesh, boundary, load.where))
      with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
        const auto areas = shape_areas<F>(face_nodes<F>(mesh, face));
        for (int a = 0; a < F::nodes; ++a) add(face.nodes[static_cast<std::size_t>(a)], areas[a] * load.traction);
      });
  for (const auto& load : scene.pressures())
    for (const auto& face : resolve_faces(mesh, boundary, load.where))
      with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
        const auto areas = shape_area_vectors<F>(face_nodes<F>(mesh, face));
        for (int a = 0; a < F::nodes; ++a)
          add(face.nodes[static_cast<std::size_t>(a)], -load.pressure * areas.row(a).transpose());
      });
  for (const auto& load : scene.point_loads()) {
    const auto nodes = resolve_nodes(mesh, boundary, load.where);
    for (NodeId node : nodes) add(node, load.force / static_cast<double>(nodes.size()));
  }
  for (const auto& load : scene.body_loads()) {
    require_region(mesh, load.region);
    for (Index e = 0; e < mesh.element_count(); ++e) {
      if (load.region != everywhere && mesh.region_name(mesh.region(e)) != load.region) continue;
      const auto v = shape_volumes<E>(element_nodes<E>(mesh, e));
      for (int a = 0; a < E::nodes; ++a)
        add(mesh.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)], v[a] * load.force_per_volume);
    }
  }
  return f;
}

/// Load f_0 of initial strains per region, those of the body if none are given (3.28, 3.45): 3 nodes entries [N].
template <Element E>
VectorX initial_strain_load(const Body<E>& body, const std::vector<Vector6>& strains) {
  VectorX f = VectorX::Zero(3 * body.mesh.node_count());
  if (std::ranges::all_of(strains, [](const Vector6& s) { return s.isZero(0.0); })) return f;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto fe =
        initial_strain_load<E>(element_nodes<E>(body.mesh, e), body.elasticity_of(e), strains[body.region_of(e)]);
    for (int a = 0; a < E::nodes; ++a)
      f.template segment<3>(3 * Index{body.mesh.element_node(e, a)}) += fe.row(a).transpose();
  }
  return f;
}

template <Element E>
VectorX initial_strain_load(const Body<E>& body) {
  return initial_strain_load(body, body.initial_strain);
}

/// Initial strain per region of a scene; several on one region add up. Throws unknown_group.
template <Element E>
std::vector<Vector6> initial_strains_by_region(const Mesh<E>& mesh, const Scene& scene) {
  std::vector<Vector6> strains(mesh.region_names.size(), Vector6::Zero());
  for (const auto& s : scene.initial_strains()) {
    require_region(mesh, s.region);
    for (std::size_t r = 0; r < strains.size(); ++r)
      if (s.region == everywhere || mesh.region_names[r] == s.region) strains[r] += s.strain;
  }
  return strains;
}

/// Stored energy [J]: 1/2 sum_q (epsilon - epsilon_0) : D : (epsilon - epsilon_0) dV for nodal displacements u (3 nodes
/// entries [m]).
template <Element E>
double strain_energy(const Body<E>& body, const VectorX& u) {
  double energy = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(body.mesh, e);
    ElementNodes<E> ue;
    for (int a = 0; a < E::nodes; ++a)
      ue.row(a) = u.template segment<3>(3 * Index{body.mesh.element_node(e, a)}).transpose();
    for (const IntegrationPoint<E>& point : integration_points<E>(x)) {
      const Vector6 elastic = strain_at<E>(point, ue) - body.initial_strain[body.region_of(e)];
      energy += 0.5 * point.volume * elastic.dot(body.elasticity_of(e) * elastic);
    }
  }
  return energy;
}

}}  // namespace palpate
