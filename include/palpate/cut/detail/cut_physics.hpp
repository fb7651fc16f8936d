// Material and loads of the elements of a body that is cut.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
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

namespace detail {

/// Loads of a scene without gravity and initial strains, by element, so that an element that leaves the body takes its
/// loads with it. Point loads stay with the node to which they were applied.
template <Element E>
struct ElementLoads {
  VectorX nodal_load;                 ///< point loads, 3 per node of the mesh [N]
  std::vector<ElementNodes<E>> load;  ///< on the nodes of every element, one row per node [N]

  /// Body loads, tractions, pressures and point loads, resolved on the body before any cut. Throws as the loads of a
  /// scene. O(elements).
  ElementLoads(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary, const Scene& scene)
      : nodal_load(VectorX::Zero(3 * mesh.node_count())), load(mesh.elements.size(), ElementNodes<E>::Zero()) {
    for (const auto& point : scene.point_loads()) {
      const auto nodes = resolve_nodes(mesh, boundary, point.where);
      for (const NodeId n : nodes)
        add_node_vector(nodal_load, Index{n}, point.force / static_cast<double>(nodes.size()));
    }
    add_body_loads(mesh, scene);
    for (const auto& t : scene.tractions()) add_on_faces(mesh, boundary, t.where, t.traction, 0.0);
    for (const auto& p : scene.pressures()) add_on_faces(mesh, boundary, p.where, Vector3::Zero(), p.pressure);
  }

 private:
  void add_body_loads(const Mesh<E>& mesh, const Scene& scene) {
    for (const auto& b : scene.body_loads()) require_region(mesh, b.region);
    if (scene.body_loads().empty()) return;
    for (Index e = 0; e < mesh.element_count(); ++e) {
      Vector3 density = Vector3::Zero();
      for (const auto& b : scene.body_loads())
        if (b.region == everywhere || mesh.region_names[static_cast<std::size_t>(mesh.region(e))] == b.region)
          density += b.force_per_volume;
      if (!density.isZero(0.0))
        load[static_cast<std::size_t>(e)] += shape_volumes<E>(element_nodes<E>(mesh, e)) * density.transpose();
    }
  }
  void add_on_faces(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary, const Selection& where,
                    const Vector3& traction, double pressure) {
    for (const auto& face : resolve_faces(mesh, boundary, where))
      with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
        const auto x = detail::face_nodes<F>(mesh, face);
        const FaceNodes<F> f = shape_areas<F>(x) * traction.transpose() - pressure * shape_area_vectors<F>(x);
        const auto& nodes = mesh.elements[static_cast<std::size_t>(face.element)];
        for (int a = 0; a < F::nodes; ++a) {
          const auto place = std::ranges::find(nodes, face.nodes[static_cast<std::size_t>(a)]) - nodes.begin();
          load[static_cast<std::size_t>(face.element)].row(place) += f.row(a);
        }
      });
  }
};

}  // namespace detail

/// Material and loads by element: those of ElementLoads with gravity and initial strains.
template <Element E>
requires(!detail::HasSmoothedStrain<E>) struct CutPhysics : detail::ElementLoads<E> {
  using detail::ElementLoads<E>::load;
  using detail::ElementLoads<E>::nodal_load;
  Body<E> body;        ///< its mesh has the nodes and elements as given
  VectorX prescribed;  ///< displacements, 3 per given node [m]

  /// Loads of a scene: gravity in the frame of the mesh, body loads, tractions, pressures, initial strains. Throws as
  /// the conditions of a scene. O(elements).
  CutPhysics(Body<E> given, const std::vector<BoundaryFace>& boundary, const Scene& scene)
      : detail::ElementLoads<E>(given.mesh, boundary, scene), body(std::move(given)) {
    body.initial_strain = detail::initial_strains_by_region(body.mesh, scene);
    prescribed = resolve_essential(body.mesh, boundary, scene).prescribed;
    add_weight(scene);
  }

  /// Element stiffness [N/m] at the rest positions of the nodes.
  detail::ElementStiffness<E> stiffness(Index e) const {
    return detail::element_stiffness<E>(nodes_of_element(e), body.elasticity_of(e));
  }
  /// Mass of an element [kg].
  double mass(Index e) const {
    return body.density[body.region_of(e)] * detail::shape_volumes<E>(nodes_of_element(e)).sum();
  }
  /// The load of one element as a column, x y z per node.
  Eigen::Matrix<double, 3 * E::nodes, 1> load_of(Index e) const {
    Eigen::Matrix<double, 3 * E::nodes, 1> f;
    for (int a = 0; a < E::nodes; ++a)
      f.template segment<3>(3 * a) = load[static_cast<std::size_t>(e)].row(a).transpose();
    return f;
  }

 private:
  ElementNodes<E> nodes_of_element(Index e) const { return element_nodes<E>(body.mesh, e); }

  void add_weight(const Scene& scene) {
    for (Index e = 0; e < body.mesh.element_count(); ++e) {
      const std::size_t region = body.region_of(e);
      const Vector3 weight = body.density[region] * scene.gravity();
      if (!scene.gravity().isZero(0.0) && !(body.density[region] > 0.0))
        raise(SetupErrorKind::bad_density,
              "there is gravity, but region '" + body.mesh.region_names[region] + "' has no density");
      ElementNodes<E>& f = load[static_cast<std::size_t>(e)];
      if (!weight.isZero(0.0)) f += detail::shape_volumes<E>(nodes_of_element(e)) * weight.transpose();
      if (!body.initial_strain[region].isZero(0.0))
        f += detail::initial_strain_load<E>(nodes_of_element(e), body.elasticity_of(e), body.initial_strain[region]);
    }
  }
};

}}  // namespace palpate
