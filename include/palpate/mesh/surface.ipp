// Definitions of surface.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/key_order.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE SortedFaces sorted_faces(const MeshRef& mesh) {
  const ElementLayout& element = mesh.element;
  SortedFaces faces{element.face.nodes, element.face_count, {}, {}};
  faces.keys.assign(static_cast<std::size_t>(mesh.element_count * faces.per_element * faces.width), -1);
  NodeId* key = faces.keys.data();
  for (Index e = 0; e < mesh.element_count; ++e)
    for (int f = 0; f < faces.per_element; ++f, key += faces.width) {
      NodeId* end = key;
      for (const int local : element.local_face(f)) *end++ = mesh.nodes_of(e)[local];
      std::sort(key, end);
      if (key[0] < 0 || end[-1] >= mesh.node_count)
        raise_at(SetupIds::elements, e, SetupErrorKind::index_out_of_range,
                 "an element names a node that does not exist");
    }
  faces.order = key_order(faces.keys, faces.width, mesh.node_count);
  return faces;
}

PALPATE_INLINE std::vector<NodeId> face_keys(const std::vector<BoundaryFace>& faces, int width) {
  std::vector<NodeId> keys(faces.size() * static_cast<std::size_t>(width), -1);
  NodeId* key = keys.data();
  for (const BoundaryFace& face : faces) {
    std::sort(key, std::copy(face.nodes.begin(), face.nodes.end(), key));
    key += width;
  }
  return keys;
}

PALPATE_INLINE std::vector<BoundaryFace> sort_unique(const std::vector<BoundaryFace>& faces, int width,
                                                     Index node_count) {
  const std::vector<NodeId> keys = face_keys(faces, width);
  const std::vector<Index> order = key_order(keys, width, node_count);
  std::vector<BoundaryFace> result;
  result.reserve(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto key = keys.begin() + order[i] * width;
    if (i == 0 || !std::equal(key, key + width, keys.begin() + order[i - 1] * width))
      result.push_back(faces[static_cast<std::size_t>(order[i])]);
  }
  return result;
}

}  // namespace detail

PALPATE_INLINE std::vector<BoundaryFace> extract_boundary(const MeshRef& mesh) {
  const detail::SortedFaces faces = detail::sorted_faces(mesh);
  std::vector<Index> single, bad;  // places of faces; elements
  for (Index i = 0; i < faces.count();) {
    Index j = i + 1;
    while (j < faces.count() && std::equal(faces.key(i), faces.key(i) + faces.width, faces.key(j))) ++j;
    if (j - i == 1)
      single.push_back(i);
    else if (j - i > 2)
      bad.push_back(faces.element(i));
    i = j;
  }
  if (!bad.empty()) {
    SetupProblem p;
    p.kind = SetupErrorKind::non_manifold;
    p.what = "a face is shared by three or more elements";
    p.hint = "Remove the overlapping elements";
    p.set_ids(bad, SetupIds::elements);
    raise(std::move(p));
  }
  std::ranges::stable_sort(single, {}, [&](Index i) { return faces.element(i); });
  std::vector<BoundaryFace> boundary;
  boundary.reserve(single.size());
  for (const Index i : single) {
    const auto local = mesh.element.local_face(faces.local(i));
    BoundaryFace& face =
        boundary.emplace_back(BoundaryFace{decltype(BoundaryFace::nodes)(local.size()), faces.element(i)});
    for (std::size_t a = 0; a < local.size(); ++a) face.nodes[a] = mesh.nodes_of(face.element)[local[a]];
  }
  return boundary;
}

PALPATE_INLINE std::vector<NodeId> nodes_of(const std::vector<BoundaryFace>& faces) {
  std::vector<NodeId> nodes;
  for (const auto& f : faces) nodes.insert(nodes.end(), f.nodes.begin(), f.nodes.end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}}  // namespace palpate
