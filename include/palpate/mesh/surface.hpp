// The boundary of a solid mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/detail/face_ids.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Largest number of nodes of an element face: quadrilaterals of degree 3 have 16.
inline constexpr int max_face_nodes = 16;

}  // namespace detail

/// A face of the boundary: its nodes, outward by the right-hand rule, and the element it belongs to.
struct BoundaryFace {
  detail::ShortIds<static_cast<std::size_t>(detail::max_face_nodes)> nodes;
  Index element = 0;

  /// Sorted node ids: the same for every ordering of the face's nodes.
  auto key() const {
    auto k = nodes;
    std::sort(k.begin(), k.end());
    return k;
  }
};

namespace detail {

/// A face of an element with a key that is the same for all elements that share it.
template <Element E>
struct KeyedFace {
  FaceIds<E> key;  ///< sorted nodes
  int local = 0;
  Index element = 0;
};

/// All faces of all elements, equal keys adjacent and ordered by element.
struct SortedFaces {
  int width = 0;             ///< numbers per key
  int per_element = 0;       ///< faces
  std::vector<NodeId> keys;  ///< sorted nodes of every face, element by element; small faces are padded with -1
  std::vector<Index> order;  ///< places in `keys`

  Index count() const noexcept { return static_cast<Index>(order.size()); }
  const NodeId* key(Index i) const noexcept { return keys.data() + order[static_cast<std::size_t>(i)] * width; }
  Index element(Index i) const noexcept { return order[static_cast<std::size_t>(i)] / per_element; }
  int local(Index i) const noexcept { return static_cast<int>(order[static_cast<std::size_t>(i)] % per_element); }
};
SortedFaces sorted_faces(const MeshRef& mesh);

/// Keys of faces as in SortedFaces.
std::vector<NodeId> face_keys(const std::vector<BoundaryFace>& faces, int width);

/// Faces in the order of their keys of at most `width` nodes, each once.
std::vector<BoundaryFace> sort_unique(const std::vector<BoundaryFace>& faces, int width, Index node_count);

/// All faces of all elements, equal keys adjacent and ordered by element. O(faces), allocates.
template <Element E, MeshOf<E> M>
std::vector<KeyedFace<E>> sorted_faces(const M& mesh) {
  const SortedFaces sorted = sorted_faces(plain_view<E>(mesh).mesh);
  std::vector<KeyedFace<E>> faces;
  faces.reserve(sorted.order.size());
  for (Index i = 0; i < sorted.count(); ++i) {
    FaceIds<E> key = make_face_ids<E>(local_face<E>(static_cast<std::size_t>(sorted.local(i))).size());
    std::copy_n(sorted.key(i), key.size(), key.begin());
    faces.push_back({key, sorted.local(i), sorted.element(i)});
  }
  return faces;
}

}  // namespace detail

/// All faces that belong to exactly one element, ordered by element. Node order is that of the element, hence outward
/// if the element is positively oriented. A face shared by three or more elements is refused as non_manifold. O(faces),
/// allocates.
std::vector<BoundaryFace> extract_boundary(const MeshRef& mesh);

/// The same for any mesh.
template <Element E, MeshOf<E> M>
std::vector<BoundaryFace> extract_boundary(const M& mesh) {
  static_assert(E::Face::nodes <= detail::max_face_nodes, "palpate: a face has at most 16 nodes");
  return extract_boundary(detail::plain_view<E>(mesh).mesh);
}

/// The unique nodes of faces, sorted.
std::vector<NodeId> nodes_of(const std::vector<BoundaryFace>& faces);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/surface.ipp>
#endif
