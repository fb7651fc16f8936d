// The boundary of a solid mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/face_ids.hpp>

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A face of the boundary: its nodes, outward by the right-hand rule, and the element it belongs to.
template <Element E>
struct BoundaryFace {
  FaceIds<E> nodes;
  Index element = 0;

  /// Sorted node ids: the same for every ordering of the face's nodes.
  auto key() const {
    auto k = nodes;
    std::ranges::sort(k);
    return k;
  }
};

/// A face of an element with the name all elements give it.
template <Element E>
struct KeyedFace {
  FaceIds<E> key;  ///< sorted nodes
  int local = 0;
  Index element = 0;
};

/// All faces of all elements, equal keys side by side and ordered by element. O(faces), allocates.
template <Element E, MeshOf<E> M>
std::vector<KeyedFace<E>> sorted_faces(const M& mesh) {
  // By lowest node first: what is left to sort are the few faces around a node.
  std::vector<Index> start(static_cast<std::size_t>(mesh.node_count()) + 1, 0);
  const auto each_face = [&](auto&& visit) {
    for (Index e = 0; e < mesh.element_count(); ++e)
      for (std::size_t f = 0; f < E::faces.size(); ++f) {
        KeyedFace<E> face{face_ids<E>(mesh, e, f), static_cast<int>(f), e};
        std::ranges::sort(face.key);
        if (face.key.front() < 0 || face.key.back() >= mesh.node_count())
          raise(SetupErrorKind::index_out_of_range,
                "element " + std::to_string(e) + " names a node that does not exist");
        visit(face);
      }
  };
  each_face([&](const KeyedFace<E>& face) { ++start[static_cast<std::size_t>(face.key[0]) + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<KeyedFace<E>> faces(static_cast<std::size_t>(start.back()));
  std::vector<Index> next(start.begin(), start.end() - 1);
  each_face([&](const KeyedFace<E>& face) {
    faces[static_cast<std::size_t>(next[static_cast<std::size_t>(face.key[0])]++)] = face;
  });
  for (std::size_t i = 0; i + 1 < start.size(); ++i)
    std::sort(faces.begin() + start[i], faces.begin() + start[i + 1], [](const KeyedFace<E>& a, const KeyedFace<E>& b) {
      return std::tie(a.key, a.element) < std::tie(b.key, b.element);
    });
  return faces;
}

/// All faces that belong to exactly one element, ordered by element. Node order is that of the element, hence outward
/// when the element is positively oriented. A face shared by three or more elements is refused as non_manifold.
/// O(faces), allocates.
template <Element E, MeshOf<E> M>
std::vector<BoundaryFace<E>> extract_boundary(const M& mesh) {
  const std::vector<KeyedFace<E>> faces = sorted_faces<E>(mesh);
  std::vector<BoundaryFace<E>> boundary;
  std::vector<Index> bad;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
    if (j - i == 1) {
      const Index e = faces[i].element;
      boundary.push_back({face_ids<E>(mesh, e, static_cast<std::size_t>(faces[i].local)), e});
    } else if (j - i > 2) {
      bad.push_back(faces[i].element);
    }
    i = j;
  }
  if (!bad.empty()) {
    SetupProblem p;
    p.kind = SetupErrorKind::non_manifold;
    p.what = "a face is shared by three or more elements";
    p.hint = "Remove the overlapping elements";
    p.set_ids(bad);
    raise(std::move(p));
  }
  std::ranges::stable_sort(boundary, {}, &BoundaryFace<E>::element);
  return boundary;
}

/// The unique nodes of faces, sorted.
template <Element E>
std::vector<NodeId> nodes_of(const std::vector<BoundaryFace<E>>& faces) {
  std::vector<NodeId> nodes;
  for (const auto& f : faces) nodes.insert(nodes.end(), f.nodes.begin(), f.nodes.end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}}  // namespace palpate
