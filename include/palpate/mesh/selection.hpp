// From the names of a scene to nodes, faces and elements of a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/face_ids.hpp>
#include <palpate/mesh/groups.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Text for messages.
std::string selection_name(const Selection& s);

/// The nodes of a selection, sorted and unique. Throws unknown_group, empty_group or index_out_of_range.
/// A group called "surface" that the mesh does not define is its whole boundary; a region's name selects the region's
/// nodes.
template <Element E>
std::vector<NodeId> resolve_nodes(const Mesh<E>& mesh, const std::vector<BoundaryFace<E>>& boundary,
                                  const Selection& selection) {
  std::vector<NodeId> nodes;
  if (const auto* list = std::get_if<std::vector<NodeId>>(&selection)) {
    nodes = *list;
  } else {
    const std::string& name = std::get<std::string>(selection);
    if (const Group* group = mesh.find_group(name)) {
      nodes = group->nodes;
    } else if (name == surface_group) {
      nodes = nodes_of(boundary);
    } else if (const auto region = std::ranges::find(mesh.region_names, name); region != mesh.region_names.end()) {
      for (Index e = 0; e < mesh.element_count(); ++e)
        if (mesh.region(e) == region - mesh.region_names.begin())
          for (NodeId a : mesh.elements[static_cast<std::size_t>(e)]) nodes.push_back(a);
    } else {
      std::string known;
      for (const Group& g : mesh.groups.all()) known += ' ' + g.name;
      raise(SetupErrorKind::unknown_group, "the mesh has no group '" + name + "'",
            "It has:" + (known.empty() ? " none" : known));
    }
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.empty()) raise(SetupErrorKind::empty_group, selection_name(selection) + " holds no node");
  if (nodes.front() < 0 || nodes.back() >= mesh.node_count())
    raise(SetupErrorKind::index_out_of_range,
          selection_name(selection) + " names a node outside 0 ... " + std::to_string(mesh.node_count() - 1));
  return nodes;
}

/// The boundary faces of a selection, outward whatever the order in the mesh file. A group that lists faces means
/// exactly those; a group or list of nodes means every boundary face all of whose nodes it holds. Throws empty_group,
/// or unsupported for a face inside the body.
template <Element E>
std::vector<BoundaryFace<E>> resolve_faces(const Mesh<E>& mesh, const std::vector<BoundaryFace<E>>& boundary,
                                           const Selection& selection) {
  std::vector<BoundaryFace<E>> faces;
  const auto* name = std::get_if<std::string>(&selection);
  const Group* group = name != nullptr ? mesh.find_group(*name) : nullptr;
  if (group != nullptr && !group->faces.empty()) {
    std::vector<const BoundaryFace<E>*> by_key;
    for (const auto& f : boundary) by_key.push_back(&f);
    std::ranges::sort(by_key, {}, [](const auto* f) { return f->key(); });
    for (const auto& nodes : group->faces) {
      if (is_face_size<E>(nodes.size())) {
        FaceIds<E> key = make_face_ids<E>(nodes.size());
        std::ranges::copy(nodes, key.begin());
        std::ranges::sort(key);
        const auto it = std::ranges::lower_bound(by_key, key, {}, [](const auto* f) { return f->key(); });
        if (it != by_key.end() && (*it)->key() == key) {
          faces.push_back(**it);
          continue;
        }
      }
      raise(SetupErrorKind::unsupported, "group '" + *name + "' has a face that is not on the boundary of the body",
            "Load boundary faces only");
    }
  } else {
    const std::vector<NodeId> nodes = resolve_nodes(mesh, boundary, selection);
    for (const auto& f : boundary)
      if (std::ranges::all_of(f.nodes, [&](NodeId a) { return std::ranges::binary_search(nodes, a); }))
        faces.push_back(f);
  }
  std::ranges::sort(faces, {}, [](const auto& f) { return f.key(); });
  const auto last =
      std::unique(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.key() == b.key(); });
  faces.erase(last, faces.end());
  if (faces.empty()) raise(SetupErrorKind::empty_group, selection_name(selection) + " holds no boundary face");
  return faces;
}

/// Refuses the name of a region that does not exist (unknown_group); `everywhere` always exists.
template <Element E>
void require_region(const Mesh<E>& mesh, const std::string& name) {
  if (name != everywhere && std::ranges::find(mesh.region_names, name) == mesh.region_names.end())
    raise(SetupErrorKind::unknown_group, "the mesh has no region '" + name + "'");
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/selection.ipp>
#endif
