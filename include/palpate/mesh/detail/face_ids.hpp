// The nodes of a face of an element.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Up to N node ids, compared lexicographically.
template <std::size_t N>
class ShortIds {
 public:
  ShortIds() = default;
  explicit ShortIds(std::size_t size) : size_(size) {}

  std::size_t size() const noexcept { return size_; }
  auto begin() noexcept { return ids_.begin(); }
  auto end() noexcept { return ids_.begin() + static_cast<std::ptrdiff_t>(size_); }
  auto begin() const noexcept { return ids_.begin(); }
  auto end() const noexcept { return ids_.begin() + static_cast<std::ptrdiff_t>(size_); }
  NodeId& operator[](std::size_t i) noexcept { return ids_[i]; }
  NodeId operator[](std::size_t i) const noexcept { return ids_[i]; }
  NodeId front() const noexcept { return ids_[0]; }
  NodeId back() const noexcept { return ids_[size_ - 1]; }
  friend auto operator<=>(const ShortIds&, const ShortIds&) = default;

 private:
  std::array<NodeId, N> ids_{};
  std::size_t size_ = 0;
};

/// Node ids of a face of E; an array if all faces have the same number of nodes.
template <Element E>
using FaceIds = std::conditional_t<HasSmallFace<E>, ShortIds<static_cast<std::size_t>(E::Face::nodes)>,
                                   std::array<NodeId, static_cast<std::size_t>(E::Face::nodes)>>;

/// Storage for a face with that many nodes.
template <Element E>
FaceIds<E> make_face_ids([[maybe_unused]] std::size_t nodes) {
  if constexpr (HasSmallFace<E>)
    return FaceIds<E>(nodes);
  else
    return {};
}

/// Nodes of face f of element e, in the element's order.
template <Element E, MeshOf<E> M>
FaceIds<E> face_ids(const M& mesh, Index e, std::size_t f) {
  const auto local = local_face<E>(f);
  FaceIds<E> ids = make_face_ids<E>(local.size());
  for (std::size_t a = 0; a < local.size(); ++a) ids[a] = static_cast<NodeId>(mesh.element_node(e, local[a]));
  return ids;
}

}}}  // namespace palpate::detail
