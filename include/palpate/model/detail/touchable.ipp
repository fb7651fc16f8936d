// Definitions of touchable.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <string>
#include <variant>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void sort_unique(std::vector<NodeId>& nodes) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

/// The faces of the boundary that are not among `touched`, for any order of their nodes.
inline std::vector<BoundaryFace> other_faces(const std::vector<BoundaryFace>& boundary,
                                             const std::vector<BoundaryFace>& touched) {
  std::vector<decltype(BoundaryFace{}.key())> keys;
  for (const BoundaryFace& face : touched) keys.push_back(face.key());
  std::ranges::sort(keys);
  std::vector<BoundaryFace> others;
  for (const BoundaryFace& face : boundary)
    if (!std::ranges::binary_search(keys, face.key())) others.push_back(face);
  return others;
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
  const std::vector<BoundaryFace> touched = sort_unique(faces, mesh.element.face.nodes, mesh.node_count);
  const std::vector<BoundaryFace> rest = other_faces(boundary, touched);
  for (const auto& face : rest)
    for (const NodeId node : face.nodes)
      if (!std::ranges::binary_search(touchable.nodes, node)) touchable.shell_nodes.push_back(node);
  sort_unique(touchable.shell_nodes);
  const auto vertex = [&](NodeId node) {
    const auto own = std::ranges::lower_bound(touchable.nodes, node);
    if (own != touchable.nodes.end() && *own == node) return static_cast<int>(own - touchable.nodes.begin());
    const auto other = std::ranges::lower_bound(touchable.shell_nodes, node) - touchable.shell_nodes.begin();
    return static_cast<int>(touchable.nodes.size()) + static_cast<int>(other);
  };
  const auto add = [&](const std::vector<BoundaryFace>& from, std::vector<Triangle>& to) {
    for (const auto& face : from) {
      const auto at = [&](int local) { return vertex(face.nodes[static_cast<std::size_t>(local)]); };
      const FaceLayout& layout = mesh.element.face_of(face.nodes.size());
      for (int t = 0; t < layout.triangle_count; ++t) {
        const auto& [i, j, k] = layout.triangles[t];
        to.push_back({at(i), at(j), at(k)});
      }
    }
  };
  add(touched, touchable.triangles);
  for (const auto& face : touched)
    touchable.elements.insert(touchable.elements.end(),
                              static_cast<std::size_t>(mesh.element.face_of(face.nodes.size()).triangle_count),
                              face.element);
  add(rest, touchable.shell);
  touchable.faces = touched;
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

}}}  // namespace palpate::detail
