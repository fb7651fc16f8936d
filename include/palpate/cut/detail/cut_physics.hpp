// Material and loads of the elements of a body that is cut.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/detail/smoothed_strain.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Material and loads by element: a removed element takes its loads with it. Point loads stay with the node to which
/// they were applied.
template <Element E>
requires(!HasSmoothedStrain<E>) struct CutPhysics {
  Body<E> body;                       ///< its mesh has the nodes and elements as given
  VectorX nodal_load;                 ///< point loads, 3 per given node [N]
  VectorX prescribed;                 ///< displacements, 3 per given node [m]
  std::vector<ElementNodes<E>> load;  ///< on the nodes of every element, one row per node [N]

  /// Loads of a scene: gravity in the frame of the mesh, body loads, tractions, pressures, initial strains. Throws as
  /// the conditions of a scene. O(elements).
  CutPhysics(Body<E> given, const std::vector<BoundaryFace>& boundary, const Scene& scene)
      : body(std::move(given)), load(body.mesh.elements.size(), ElementNodes<E>::Zero()) {
    body.initial_strain = initial_strains_by_region(body.mesh, scene);
    nodal_load = VectorX::Zero(3 * body.mesh.node_count());
    for (const auto& point : scene.point_loads()) {
      const auto nodes = resolve_nodes(body.mesh, boundary, point.where);
      for (const NodeId n : nodes)
        nodal_load.template segment<3>(3 * Index{n}) += point.force / static_cast<double>(nodes.size());
    }
    prescribed = resolve_essential(body.mesh, boundary, scene).prescribed;
    add_volume_loads(scene);
    add_face_loads(boundary, scene);
  }

  /// Element stiffness [N/m] at the rest positions of the nodes.
  ElementStiffness<E> stiffness(Index e) const {
    return element_stiffness<E>(nodes_of_element(e), body.elasticity_of(e));
  }
  /// Mass of an element [kg].
  double mass(Index e) const { return body.density[body.region_of(e)] * shape_volumes<E>(nodes_of_element(e)).sum(); }
  /// The load of one element as a column, x y z per node.
  Eigen::Matrix<double, 3 * E::nodes, 1> load_of(Index e) const {
    Eigen::Matrix<double, 3 * E::nodes, 1> f;
    for (int a = 0; a < E::nodes; ++a)
      f.template segment<3>(3 * a) = load[static_cast<std::size_t>(e)].row(a).transpose();
    return f;
  }

  /// Load of the remaining elements when those with gone(element) are removed: 3 per given node [N].
  template <class Gone>
  VectorX load_left(Gone&& gone) const {
    VectorX sum = nodal_load;
    for (Index e = 0; e < body.mesh.element_count(); ++e)
      if (!gone(e))
        for (int a = 0; a < E::nodes; ++a)
          sum.template segment<3>(3 * Index{body.mesh.element_node(e, a)}) +=
              load[static_cast<std::size_t>(e)].row(a).transpose();
    return sum;
  }

 private:
  ElementNodes<E> nodes_of_element(Index e) const { return element_nodes<E>(body.mesh, e); }

  void add_volume_loads(const Scene& scene) {
    for (const auto& b : scene.body_loads()) require_region(body.mesh, b.region);
    for (Index e = 0; e < body.mesh.element_count(); ++e) {
      const std::size_t region = body.region_of(e);
      Vector3 density = body.density[region] * scene.gravity();
      if (!scene.gravity().isZero(0.0) && !(body.density[region] > 0.0))
        raise(SetupErrorKind::bad_density,
              "there is gravity, but region '" + body.mesh.region_names[region] + "' has no density");
      for (const auto& b : scene.body_loads())
        if (b.region == everywhere || body.mesh.region_names[region] == b.region) density += b.force_per_volume;
      ElementNodes<E>& f = load[static_cast<std::size_t>(e)];
      if (!density.isZero(0.0)) f += shape_volumes<E>(nodes_of_element(e)) * density.transpose();
      if (!body.initial_strain[region].isZero(0.0))
        f += initial_strain_load<E>(nodes_of_element(e), body.elasticity_of(e), body.initial_strain[region]);
    }
  }
  void add_face_loads(const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    const auto add = [&](const Selection& where, const Vector3& traction, double pressure) {
      for (const auto& face : resolve_faces(body.mesh, boundary, where))
        with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
          const auto x = palpate::face_nodes<F>(body.mesh, face);
          const FaceNodes<F> f = shape_areas<F>(x) * traction.transpose() - pressure * shape_area_vectors<F>(x);
          const auto& nodes = body.mesh.elements[static_cast<std::size_t>(face.element)];
          for (int a = 0; a < F::nodes; ++a) {
            const auto place = std::ranges::find(nodes, face.nodes[static_cast<std::size_t>(a)]) - nodes.begin();
            load[static_cast<std::size_t>(face.element)].row(place) += f.row(a);
          }
        });
    };
    for (const auto& t : scene.tractions()) add(t.where, t.traction, 0.0);
    for (const auto& p : scene.pressures()) add(p.where, Vector3::Zero(), p.pressure);
  }
};

}}  // namespace palpate
