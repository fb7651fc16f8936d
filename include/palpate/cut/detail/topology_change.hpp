// The order of a cut, and its result on a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A face of an element by its index in E::faces.
struct ElementFace {
  Index element = 0;
  int face = 0;
};

/// Elements to remove (burning, drilling) and faces to open between elements (a blade). Elements already removed, and
/// faces without a neighbour, are ignored.
struct CutOrder {
  std::vector<Index> remove;
  std::vector<ElementFace> open;

  bool empty() const noexcept { return remove.empty() && open.empty(); }
};

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
  std::vector<NodeCopy> copies;                   ///< with ascending ids
  std::vector<NodeId> bare_nodes;                 ///< of the supported body, used by no element any more
  std::vector<ElementFace> exposed;               ///< faces that are now on the surface
  std::vector<Fragment> fragments;                ///< detached by this cut

  bool empty() const noexcept { return elements.empty() && detached_elements.empty(); }
};

}}  // namespace palpate
