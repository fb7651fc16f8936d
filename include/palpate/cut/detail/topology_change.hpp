// What a cut asks for, and what it did to a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A face of an element by its place in E::faces.
struct ElementFace {
  Index element = 0;
  int face = 0;
};

/// Elements to remove (burning, drilling) and faces to open between elements (a blade). What is gone already, and a
/// face that nothing lies behind, is passed over.
struct CutOrder {
  std::vector<Index> remove;
  std::vector<ElementFace> open;

  bool empty() const noexcept { return remove.empty() && open.empty(); }
};

/// An element that a cut took away, or moved to copies of its nodes.
template <Element E>
struct ChangedElement {
  Index element = 0;
  typename Mesh<E>::Connectivity before{}, after{};
  bool removed = false;
};

/// A node that a cut made: it lies where its parent lies.
struct NodeCopy {
  NodeId node = 0, parent = 0;
};

/// A part of the body that nothing holds any more: a body of its own, for the caller to move or to show.
struct Fragment {
  std::vector<Index> elements;
  std::vector<NodeId> nodes;  ///< sorted
  double volume = 0.0;        ///< [m^3]
  int free_modes = 6;         ///< rigid motions that the constraints left on it allow
};

/// All that a cut did. Changes of elements that were loose already are listed apart: no static answer depends on them.
template <Element E>
struct TopologyChange {
  std::vector<ChangedElement<E>> elements;        ///< of the held body, by ascending number
  std::vector<ChangedElement<E>> detached_elements;  ///< of pieces that were loose before
  std::vector<NodeCopy> copies;                   ///< with ascending ids
  std::vector<NodeId> bare_nodes;                 ///< of the held body, that no element uses any more
  std::vector<ElementFace> exposed;               ///< faces that lie on the surface since
  std::vector<Fragment> fragments;                ///< that came off

  bool empty() const noexcept { return elements.empty() && detached_elements.empty(); }
};

}}  // namespace palpate
