// Loads of a scene by element, for bodies that lose elements.
#pragma once

#include <palpate/assembly/load_vector.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/small_matrix.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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
        const auto x = palpate::face_nodes<F>(mesh, face);
        const FaceNodes<F> f = shape_areas<F>(x) * traction.transpose() - pressure * shape_area_vectors<F>(x);
        const auto& nodes = mesh.elements[static_cast<std::size_t>(face.element)];
        for (int a = 0; a < F::nodes; ++a) {
          const auto place = std::ranges::find(nodes, face.nodes[static_cast<std::size_t>(a)]) - nodes.begin();
          load[static_cast<std::size_t>(face.element)].row(place) += f.row(a);
        }
      });
  }
};

}}  // namespace palpate
