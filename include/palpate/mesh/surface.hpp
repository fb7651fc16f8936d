// The boundary of a solid mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <tuple>

namespace palpate::inline PALPATE_ABI {

/// A face of the boundary: its nodes, outward by the right-hand rule, and the element it belongs to.
template <Element E>
struct BoundaryFace {
  std::array<NodeId, static_cast<std::size_t>(E::Face::nodes)> nodes;
  Index element = 0;

  /// Sorted node ids: the same for every ordering of the face's nodes.
  auto key() const {
    auto k = nodes;
    std::ranges::sort(k);
    return k;
  }
};

/// All faces that belong to exactly one element, ordered by element. Node order is that of the element, hence outward
/// when the element is positively oriented. A face shared by three or more elements is refused as non_manifold. O(faces
/// log faces), allocates.
template <Element E, MeshOf<E> M>
std::vector<BoundaryFace<E>> extract_boundary(const M& mesh) {
  using Face = BoundaryFace<E>;
  struct Keyed {
    decltype(Face{}.nodes) key;
    Index element;
    int local;
  };
  std::vector<Keyed> keyed;
  keyed.reserve(static_cast<std::size_t>(mesh.element_count()) * E::faces.size());
  for (Index e = 0; e < mesh.element_count(); ++e)
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      Keyed k{{}, e, static_cast<int>(f)};
      for (std::size_t a = 0; a < k.key.size(); ++a)
        k.key[a] = static_cast<NodeId>(mesh.element_node(e, E::faces[f][a]));
      std::ranges::sort(k.key);
      keyed.push_back(k);
    }
  std::ranges::sort(
      keyed, [](const Keyed& a, const Keyed& b) { return std::tie(a.key, a.element) < std::tie(b.key, b.element); });
  std::vector<Face> boundary;
  std::vector<Index> bad;
  for (std::size_t i = 0; i < keyed.size();) {
    std::size_t j = i + 1;
    while (j < keyed.size() && keyed[j].key == keyed[i].key) ++j;
    if (j - i == 1) {
      Face face{{}, keyed[i].element};
      const auto& local = E::faces[static_cast<std::size_t>(keyed[i].local)];
      for (std::size_t a = 0; a < local.size(); ++a)
        face.nodes[a] = static_cast<NodeId>(mesh.element_node(face.element, local[a]));
      boundary.push_back(face);
    } else if (j - i > 2) {
      bad.push_back(keyed[i].element);
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
  std::ranges::stable_sort(boundary, {}, &Face::element);
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

}  // namespace palpate::inline PALPATE_ABI
