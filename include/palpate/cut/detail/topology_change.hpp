// The order of a cut, and its result on a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// A face of an element by its index in E::faces.
struct ElementFace {
  Index element = 0;
  int face = 0;
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

/// An element that a cut removed, or moved to copies of its nodes.
template <Element E>
struct ChangedElement {
  Index element = 0;
  typename Mesh<E>::Connectivity before{}, after{};
  bool removed = false;
};

/// A node created by a cut, at the position of its parent.
struct NodeCopy {
  NodeId node = 0, parent = 0;
};

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
  std::vector<ElementFace> exposed;                  ///< faces that are now on the surface
  std::vector<Fragment> fragments;                   ///< detached by this cut

  bool empty() const noexcept { return elements.empty() && detached_elements.empty(); }
};

}  // namespace detail

}}  // namespace palpate
