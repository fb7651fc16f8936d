// The order of a cut, and its result on a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// A face of an element by its index in E::faces.
struct ElementFace {
  Index element = 0;
  int face = 0;

  friend bool operator==(const ElementFace&, const ElementFace&) = default;
};

}  // namespace detail

/// Elements to remove (burning, drilling) and faces to open between elements (a blade). Elements already removed, and
/// faces without a neighbour, are ignored.
struct CutOrder {
  std::vector<Index> remove;
  std::vector<detail::ElementFace> open;

  bool empty() const noexcept { return remove.empty() && open.empty(); }
};

namespace detail {

/// Throws index_out_of_range unless the order refers to elements 0 ... elements - 1 and to their faces.
template <Element E>
void require_ids(const CutOrder& order, Index elements) {
  const auto require = [](bool holds, Index e) {
    if (!holds)
      raise(SetupErrorKind::index_out_of_range,
            "a cut refers to element " + std::to_string(e) + " or to a face that it does not have");
  };
  const auto exists = [&](Index e) { return e >= 0 && e < elements; };
  for (const Index e : order.remove) require(exists(e), e);
  for (const ElementFace& f : order.open)
    require(exists(f.element) && f.face >= 0 && f.face < static_cast<int>(E::faces.size()), f.element);
}

/// A node that a cut moves, with its new position in the body at rest [m].
struct MovedNode {
  NodeId node = 0;
  Vector3 position = Vector3::Zero();
};

/// An edge between two nodes that a cut divides, with the position of the new node in the body at rest [m].
struct DividedEdge {
  NodeId from = 0, to = 0;
  Vector3 position = Vector3::Zero();
};

/// First nodes to move, then edges to divide with all elements around them, then what an order does. The elements must
/// keep a positive volume, except those that it removes.
struct ReshapingOrder : CutOrder {
  std::vector<MovedNode> move;
  std::vector<DividedEdge> divide;

  bool empty() const noexcept { return CutOrder::empty() && move.empty() && divide.empty(); }
};

/// An element of the given mesh, or a part of one that was divided, with its present shape: material and loads are
/// those of `whole`.
template <Element E>
struct ElementPart {
  Index whole = 0;
  ElementNodes<E> shape{};        ///< [m]
  std::uint8_t faces = 0b111111;  ///< bit f is set unless face f was made by a division
};

/// An element that a cut removed, moved to other nodes, gave another shape, or added.
template <Element E>
struct ChangedElement {
  Index element = 0;
  typename Mesh<E>::Connectivity before{}, after{};
  ElementPart<E> was{};  ///< before the cut
  bool removed = false;
  bool added = false;  ///< a part of a divided element; `before` and `was` have no meaning
};

/// A node created by a cut, at the position of its parent, or on an edge from it.
struct NodeCopy {
  NodeId node = 0, parent = 0;
};

/// What became of a face of a divided element: another element has it now, or a half of it.
struct FollowedFace {
  ElementFace from, to;
  bool is_half = false;
};

/// Adds the new halves to a list of faces, and renames those that other elements have now.
inline void follow(const FollowedFace& followed, std::vector<ElementFace>& faces) {
  for (std::size_t k = 0, count = faces.size(); k < count; ++k) {
    if (faces[k] != followed.from) continue;
    if (followed.is_half)
      faces.push_back(followed.to);
    else
      faces[k] = followed.to;
  }
}

/// A part of the body without support: a separate body, for the caller to move or to draw.
struct Fragment {
  std::vector<Index> elements;
  std::vector<NodeId> nodes;  ///< sorted
  double volume = 0.0;        ///< [m^3]
  int free_modes = 6;         ///< rigid motions left by its constraints
};

/// The full result of a cut. Changes of elements that were detached before are listed separately: no static solution
/// depends on them.
template <Element E>
struct TopologyChange {
  std::vector<ChangedElement<E>> elements;           ///< of the supported body, by ascending id
  std::vector<ChangedElement<E>> detached_elements;  ///< of fragments detached before
  std::vector<NodeCopy> copies;                      ///< with ascending ids
  std::vector<NodeId> bare_nodes;                    ///< of the supported body, used by no element any more
  std::vector<FollowedFace> followed;                ///< faces of divided elements, in the order of the divisions
  std::vector<ElementFace> exposed;                  ///< faces that are now on the surface, after that
  std::vector<Fragment> fragments;                   ///< detached by this cut

  bool empty() const noexcept { return elements.empty() && detached_elements.empty(); }
};

}  // namespace detail

}}  // namespace palpate
