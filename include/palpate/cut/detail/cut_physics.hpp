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
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/detail/face_ids.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Loads of a scene without gravity and initial strains, by element, so that an element that leaves the body takes its
/// loads with it, and one that changes its shape has those of the new one. Point loads stay with the node to which they
/// were applied.
template <Element E>
struct ElementLoads {
  VectorX nodal_load;                     ///< point loads, 3 per node of the mesh [N]
  std::vector<Vector3> force_per_volume;  ///< of every element [N/m^3]

  /// Body loads, tractions, pressures and point loads, resolved on the body before any cut. Throws as the loads of a
  /// scene. O(elements).
  ElementLoads(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary, const Scene& scene)
      : nodal_load(VectorX::Zero(3 * mesh.node_count())), force_per_volume(mesh.elements.size(), Vector3::Zero()) {
    for (const auto& point : scene.point_loads()) {
      const auto nodes = resolve_nodes(mesh, boundary, point.where);
      for (const NodeId n : nodes)
        add_node_vector(nodal_load, Index{n}, point.force / static_cast<double>(nodes.size()));
    }
    for (const auto& b : scene.body_loads()) add_body_load(mesh, b.region, b.force_per_volume);
    for (const auto& t : scene.tractions()) add_on_faces(mesh, boundary, t.where, t.traction, 0.0);
    for (const auto& p : scene.pressures()) add_on_faces(mesh, boundary, p.where, Vector3::Zero(), p.pressure);
    std::ranges::stable_sort(faces_, {}, &LoadedFace::element);
  }

  /// On the nodes of an element, one row per node [N].
  ElementNodes<E> applied_load(const ElementPart<E>& part) const {
    const Vector3& density = force_per_volume[static_cast<std::size_t>(part.whole)];
    ElementNodes<E> load = ElementNodes<E>::Zero();
    if (!density.isZero(0.0)) load += shape_volumes<E>(part.shape) * density.transpose();
    const auto [first, last] = std::ranges::equal_range(faces_, part.whole, {}, &LoadedFace::element);
    for (auto f = first; f != last; ++f)
      if ((part.faces >> f->face & 1u) != 0) add_on_face(*f, part.shape, load);
    return load;
  }

 private:
  struct LoadedFace {
    Index element = 0;
    int face = 0;  // in E::faces
    Vector3 traction = Vector3::Zero();
    double pressure = 0.0;
  };

  void add_body_load(const Mesh<E>& mesh, const std::string& region, const Vector3& density) {
    require_region(mesh, region);
    for (Index e = 0; e < mesh.element_count(); ++e)
      if (region == everywhere || mesh.region_names[static_cast<std::size_t>(mesh.region(e))] == region)
        force_per_volume[static_cast<std::size_t>(e)] += density;
  }
  void add_on_faces(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary, const Selection& where,
                    const Vector3& traction, double pressure) {
    for (const auto& face : resolve_faces(mesh, boundary, where))
      for (std::size_t local = 0; local < E::faces.size(); ++local)
        if (std::ranges::is_permutation(face_ids<E>(mesh, face.element, local), face.nodes))
          faces_.push_back({face.element, static_cast<int>(local), traction, pressure});
  }
  static void add_on_face(const LoadedFace& loaded, const ElementNodes<E>& shape, ElementNodes<E>& load) {
    const auto local = local_face<E>(static_cast<std::size_t>(loaded.face));
    with_face_element<E>(local.size(), [&]<FaceElement F>() {
      FaceNodes<F> x;
      for (int a = 0; a < F::nodes; ++a) x.row(a) = shape.row(local[static_cast<std::size_t>(a)]);
      const FaceNodes<F> f =
          shape_areas<F>(x) * loaded.traction.transpose() - loaded.pressure * shape_area_vectors<F>(x);
      for (int a = 0; a < F::nodes; ++a) load.row(local[static_cast<std::size_t>(a)]) += f.row(a);
    });
  }

  std::vector<LoadedFace> faces_;  // by element
};

}  // namespace detail

/// Material and loads by element: those of ElementLoads with gravity and initial strains.
template <Element E>
requires(!detail::HasSmoothedStrain<E>) struct CutPhysics : detail::ElementLoads<E> {
  using detail::ElementLoads<E>::force_per_volume;
  using detail::ElementLoads<E>::nodal_load;
  Body<E> body;        ///< its mesh has the nodes and elements as given
  VectorX prescribed;  ///< displacements, 3 per given node [m]

  /// Loads of a scene: gravity in the frame of the mesh, body loads, tractions, pressures, initial strains. Throws as
  /// the conditions of a scene. O(elements).
  CutPhysics(Body<E> given, const std::vector<BoundaryFace>& boundary, const Scene& scene)
      : detail::ElementLoads<E>(given.mesh, boundary, scene), body(std::move(given)) {
    body.initial_strain = detail::initial_strains_by_region(body.mesh, scene);
    prescribed = resolve_essential(body.mesh, boundary, scene).prescribed;
    add_weight(scene.gravity());
  }

  /// Element stiffness [N/m] at rest.
  detail::ElementStiffness<E> stiffness(const detail::ElementPart<E>& part) const {
    return detail::element_stiffness<E>(part.shape, body.elasticity_of(part.whole));
  }
  /// Mass of an element [kg].
  double mass(const detail::ElementPart<E>& part) const {
    return body.density[body.region_of(part.whole)] * detail::shape_volumes<E>(part.shape).sum();
  }
  /// All loads on an element as a column, x y z per node [N].
  Eigen::Matrix<double, 3 * E::nodes, 1> load_of(const detail::ElementPart<E>& part) const {
    ElementNodes<E> load = this->applied_load(part);
    const Vector6& strain = body.initial_strain[body.region_of(part.whole)];
    if (!strain.isZero(0.0)) load += detail::initial_strain_load<E>(part.shape, body.elasticity_of(part.whole), strain);
    Eigen::Matrix<double, 3 * E::nodes, 1> f;
    for (int a = 0; a < E::nodes; ++a) f.template segment<3>(3 * a) = load.row(a).transpose();
    return f;
  }
  /// Whether a node of the given mesh has a point load or a prescribed displacement that is not zero.
  bool has_own_condition(NodeId node) const {
    return !node_vector(nodal_load, Index{node}).isZero(0.0) || !node_vector(prescribed, Index{node}).isZero(0.0);
  }

 private:
  void add_weight(const Vector3& gravity) {
    if (gravity.isZero(0.0)) return;
    for (Index e = 0; e < body.mesh.element_count(); ++e) {
      const std::size_t region = body.region_of(e);
      if (!(body.density[region] > 0.0))
        raise(SetupErrorKind::bad_density,
              "there is gravity, but region '" + body.mesh.region_names[region] + "' has no density");
      force_per_volume[static_cast<std::size_t>(e)] += body.density[region] * gravity;
    }
  }
};

}}  // namespace palpate
