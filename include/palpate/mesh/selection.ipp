// Definitions of selection.hpp.
#pragma once

#include <palpate/core/detail/box.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/key_order.hpp>
#include <palpate/mesh/selection.hpp>

#include <algorithm>
#include <string>
#include <variant>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE std::string selection_name(const Selection& s) {
  if (const auto* name = std::get_if<std::string>(&s)) return "'" + *name + "'";
  if (const auto* points = std::get_if<where::PointSet>(&s)) return points->name();
  return "a list of " + std::to_string(std::get<std::vector<NodeId>>(s).size()) + " nodes";
}

inline const Group* find_group(const MeshRef& mesh, const std::string& name) noexcept {
  for (const Group& group : mesh.groups)
    if (group.name == name) return &group;
  return nullptr;
}

/// The nodes of the group, surface or region of that name, in any order.
inline std::vector<NodeId> named_nodes(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                       const std::string& name) {
  if (const Group* group = find_group(mesh, name)) return group->nodes;
  if (name == surface_group) return nodes_of(boundary);
  const auto region = std::ranges::find(mesh.region_names, name);
  if (region == mesh.region_names.end()) {
    std::string known;
    for (const Group& g : mesh.groups) known += ' ' + g.name;
    raise(SetupErrorKind::unknown_group, "the mesh has no group '" + name + "'",
          "It has:" + (known.empty() ? " none" : known));
  }
  std::vector<NodeId> nodes;
  for (Index e = 0; e < mesh.element_count; ++e)
    if (mesh.region(e) == region - mesh.region_names.begin())
      nodes.insert(nodes.end(), mesh.nodes_of(e), mesh.nodes_of(e + 1));
  return nodes;
}

/// The boundary faces that a group lists.
inline std::vector<BoundaryFace> listed_faces(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                              const Group& group) {
  const int width = mesh.element.face.nodes;
  const std::vector<NodeId> keys = face_keys(boundary, width);
  const std::vector<Index> order = key_order(keys, width, mesh.node_count);
  const auto key_of = [&](Index i) { return keys.begin() + i * width; };
  std::vector<BoundaryFace> faces;
  for (const auto& nodes : group.faces) {
    if (mesh.element.is_face_size(nodes.size())) {
      std::vector<NodeId> key = nodes;
      std::ranges::sort(key);
      key.resize(static_cast<std::size_t>(width), -1);
      const auto it = std::lower_bound(order.begin(), order.end(), key, [&](Index i, const std::vector<NodeId>& k) {
        return std::lexicographical_compare(key_of(i), key_of(i) + width, k.begin(), k.end());
      });
      if (it != order.end() && std::equal(key.begin(), key.end(), key_of(*it))) {
        faces.push_back(boundary[static_cast<std::size_t>(*it)]);
        continue;
      }
    }
    raise(SetupErrorKind::unsupported, "group '" + group.name + "' has a face that is not on the boundary of the body",
          "Load boundary faces only");
  }
  return faces;
}

inline Vector3 position_of(const MeshRef& mesh, Index node) noexcept {
  return {mesh.position(node)[0], mesh.position(node)[1], mesh.position(node)[2]};
}

inline Box box_of(const MeshRef& mesh) noexcept {
  Box box;
  for (Index i = 0; i < mesh.node_count; ++i) box.include(position_of(mesh, i));
  return box;
}

/// Hint for the refusal of a set of points that selects nothing: the extent of the mesh in the frame of the set.
inline std::string extent_hint(const MeshRef& mesh, const Selection& selection) {
  const auto* points = std::get_if<where::PointSet>(&selection);
  if (points == nullptr) return {};
  const Box box = box_of(mesh);
  return "The mesh extends from " + point_text(box.low + points->origin()) + " to " +
         point_text(box.high + points->origin()) + " [m]";
}

inline std::vector<NodeId> listed_nodes(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                        const Selection& selection) {
  if (const auto* list = std::get_if<std::vector<NodeId>>(&selection)) return *list;
  if (const auto* points = std::get_if<where::PointSet>(&selection)) return nodes_within(mesh, *points);
  return named_nodes(mesh, boundary, std::get<std::string>(selection));
}

PALPATE_INLINE double point_margin(const MeshRef& mesh) {
  return mesh.node_count == 0 ? 0.0 : 1e-6 * box_of(mesh).size().norm();
}

}  // namespace detail

PALPATE_INLINE std::vector<NodeId> nodes_within(const MeshRef& mesh, const where::PointSet& points) {
  const double margin = detail::point_margin(mesh);
  std::vector<NodeId> nodes;
  for (Index i = 0; i < mesh.node_count; ++i)
    if (points.contains(detail::position_of(mesh, i), margin)) nodes.push_back(static_cast<NodeId>(i));
  return nodes;
}

PALPATE_INLINE std::vector<Index> elements_within(const MeshRef& mesh, const where::PointSet& points) {
  const double margin = detail::point_margin(mesh);
  std::vector<Index> elements;
  for (Index e = 0; e < mesh.element_count; ++e) {
    Vector3 centre = Vector3::Zero();
    for (int a = 0; a < mesh.element.nodes; ++a) centre += detail::position_of(mesh, mesh.nodes_of(e)[a]);
    if (points.contains(centre / static_cast<double>(mesh.element.nodes), margin)) elements.push_back(e);
  }
  return elements;
}

PALPATE_INLINE std::vector<NodeId> resolve_nodes(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                                 const Selection& selection) {
  std::vector<NodeId> nodes = detail::listed_nodes(mesh, boundary, selection);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.empty())
    raise(SetupErrorKind::empty_group, detail::selection_name(selection) + " contains no node",
          detail::extent_hint(mesh, selection));
  if (nodes.front() < 0 || nodes.back() >= mesh.node_count)
    raise(SetupErrorKind::index_out_of_range,
          detail::selection_name(selection) + " names a node outside 0 ... " + std::to_string(mesh.node_count - 1));
  return nodes;
}

namespace detail {

PALPATE_INLINE std::vector<BoundaryFace> resolve_faces(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                                       const Selection& selection) {
  std::vector<BoundaryFace> faces;
  const auto* name = std::get_if<std::string>(&selection);
  const Group* group = name != nullptr ? find_group(mesh, *name) : nullptr;
  if (group != nullptr && !group->faces.empty()) {
    faces = listed_faces(mesh, boundary, *group);
  } else {
    std::vector<char> chosen(static_cast<std::size_t>(mesh.node_count), 0);
    for (NodeId i : resolve_nodes(mesh, boundary, selection)) chosen[static_cast<std::size_t>(i)] = 1;
    for (const auto& f : boundary)
      if (std::ranges::all_of(f.nodes, [&](NodeId i) { return chosen[static_cast<std::size_t>(i)] != 0; }))
        faces.push_back(f);
  }
  faces = sort_unique(faces, mesh.element.face.nodes, mesh.node_count);
  if (faces.empty())
    raise(SetupErrorKind::empty_group, selection_name(selection) + " contains no boundary face",
          extent_hint(mesh, selection));
  return faces;
}

PALPATE_INLINE void require_region(const MeshRef& mesh, const std::string& name) {
  if (name != everywhere && std::ranges::find(mesh.region_names, name) == mesh.region_names.end())
    raise(SetupErrorKind::unknown_group, "the mesh has no region '" + name + "'");
}

}  // namespace detail

}}  // namespace palpate
