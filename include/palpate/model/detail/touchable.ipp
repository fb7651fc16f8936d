// Definitions of touchable.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <string>
#include <variant>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void sort_unique(std::vector<NodeId>& nodes) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

PALPATE_INLINE Touchable resolve_touchable(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                           const Scene& scene) {
  Touchable touchable;
  std::vector<BoundaryFace> faces;
  for (const Selection& selection : scene.touched()) {
    if (!std::holds_alternative<where::PointSet>(selection)) {
      const std::vector<NodeId> nodes = resolve_nodes(mesh, boundary, selection);
      touchable.nodes.insert(touchable.nodes.end(), nodes.begin(), nodes.end());
    }
    const auto selected = resolve_faces(mesh, boundary, selection);
    faces.insert(faces.end(), selected.begin(), selected.end());
  }
  for (const auto& face : faces) touchable.nodes.insert(touchable.nodes.end(), face.nodes.begin(), face.nodes.end());
  sort_unique(touchable.nodes);
  const auto vertex = [&](NodeId node) {
    return static_cast<int>(std::ranges::lower_bound(touchable.nodes, node) - touchable.nodes.begin());
  };
  for (const auto& face : detail::sort_unique(faces, mesh.element.face.nodes, mesh.node_count)) {
    const auto at = [&](int local) { return vertex(face.nodes[static_cast<std::size_t>(local)]); };
    const FaceLayout& layout = mesh.element.face_of(face.nodes.size());
    for (int t = 0; t < layout.triangle_count; ++t) {
      const auto& [a, b, c] = layout.triangles[t];
      touchable.triangles.push_back({at(a), at(b), at(c)});
    }
  }
  return touchable;
}

PALPATE_INLINE void require_vertex_forces(std::span<const VertexForce> forces, int vertices) {
  for (const VertexForce& f : forces) {
    if (f.vertex < 0 || f.vertex >= vertices)
      raise_at(SetupIds::others, f.vertex, SetupErrorKind::index_out_of_range,
               "a force acts on a vertex that does not exist; the id is its number",
               "The contact surface has " + std::to_string(vertices) + " vertices, counted from zero");
    if (!all_finite(f.force.in_model_axes()))
      raise_at(SetupIds::others, f.vertex, SetupErrorKind::non_finite,
               "a force on a vertex is not finite; the id is the vertex");
  }
}

PALPATE_INLINE std::vector<NodeId> resolve_rendered(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                                    const Scene& scene) {
  std::vector<NodeId> rendered;
  for (const Selection& selection : scene.rendered()) {
    const std::vector<NodeId> nodes = resolve_nodes(mesh, boundary, selection);
    rendered.insert(rendered.end(), nodes.begin(), nodes.end());
  }
  sort_unique(rendered);
  return rendered;
}

}}  // namespace palpate
