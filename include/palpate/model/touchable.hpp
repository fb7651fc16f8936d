// Which part of a body can be touched, and which is looked at.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The touchable surface: its nodes, sorted, and its outward triangles in numbers of those nodes. Faces with more nodes
/// than three give the triangles their face element lists.
struct Touchable {
  std::vector<NodeId> nodes;
  std::vector<Triangle> triangles;
};

/// Sorts and drops repetitions.
void sort_unique(std::vector<NodeId>& nodes);

/// Resolves what a scene lets tools touch: the boundary faces of every selection and their nodes. Throws as
/// resolve_faces does.
template <Element E>
Touchable resolve_touchable(const Mesh<E>& mesh, const std::vector<BoundaryFace<E>>& boundary, const Scene& scene) {
  Touchable touchable;
  std::vector<BoundaryFace<E>> faces;
  for (const Selection& selection : scene.touched()) {
    const std::vector<NodeId> nodes = resolve_nodes(mesh, boundary, selection);
    touchable.nodes.insert(touchable.nodes.end(), nodes.begin(), nodes.end());
    const auto selected = resolve_faces(mesh, boundary, selection);
    faces.insert(faces.end(), selected.begin(), selected.end());
  }
  for (const auto& face : faces) touchable.nodes.insert(touchable.nodes.end(), face.nodes.begin(), face.nodes.end());
  sort_unique(touchable.nodes);
  const auto same = [](const auto& a, const auto& b) { return a.key() == b.key(); };
  std::ranges::sort(faces, {}, [](const auto& f) { return f.key(); });
  faces.erase(std::unique(faces.begin(), faces.end(), same), faces.end());
  const auto vertex = [&](NodeId node) {
    return static_cast<int>(std::ranges::lower_bound(touchable.nodes, node) - touchable.nodes.begin());
  };
  for (const auto& face : faces) {
    const auto at = [&](int local) { return vertex(face.nodes[static_cast<std::size_t>(local)]); };
    with_face_element<E>(face.nodes.size(), [&]<TriangulatedFace F>() {
      for (const auto& [a, b, c] : F::triangles) touchable.triangles.push_back({at(a), at(b), at(c)});
    });
  }
  return touchable;
}

/// The nodes somebody looks at, sorted.
template <Element E>
std::vector<NodeId> resolve_seen(const Mesh<E>& mesh, const std::vector<BoundaryFace<E>>& boundary,
                                 const Scene& scene) {
  std::vector<NodeId> seen;
  for (const Selection& selection : scene.seen()) {
    const std::vector<NodeId> nodes = resolve_nodes(mesh, boundary, selection);
    seen.insert(seen.end(), nodes.begin(), nodes.end());
  }
  sort_unique(seen);
  return seen;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/touchable.ipp>
#endif
