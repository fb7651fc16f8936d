// The touchable surface of a body that is cut.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_topology.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Faces that a tool may touch and the vertices of their nodes. Before any cut both are those of resolve_touchable, in
/// the same order. Vertices keep their numbers: new ones are appended, and those of removed parts stay at their
/// position, without a triangle. Faces exposed by a cut are touchable from then on.
template <Element E>
class CutSurface {
 public:
  CutSurface() = default;
  /// Resolves the touchable faces of a scene. Throws as resolve_touchable.
  CutSurface(const CutTopology<E>& topology, const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    const Touchable touchable = resolve_touchable(mesh_ref(topology.mesh()), boundary, scene);
    for (const NodeId node : touchable.nodes) add(topology, node);
    for (const BoundaryFace& f : touchable.faces)
      for (std::size_t local = 0; local < E::faces.size(); ++local)
        if (std::ranges::equal(topology.face_nodes({f.element, static_cast<int>(local)}), f.nodes))
          faces_.push_back({f.element, static_cast<int>(local)});
    update(topology, {});
  }

  /// Applies a cut: adds exposed faces and split nodes, drops removed faces. O(touchable faces).
  void update(const CutTopology<E>& topology, const TopologyChange<E>& change) {
    faces_.insert(faces_.end(), change.exposed.begin(), change.exposed.end());
    std::erase_if(faces_, [&](const ElementFace& f) { return topology.state(f.element) != ElementState::supported; });
    triangles_.clear();
    elements_.clear();
    used_.assign(nodes_.size(), 0);
    for (const ElementFace& f : faces_) {
      const auto face = topology.face_nodes(f);
      for (const NodeId node : face) used_[static_cast<std::size_t>(add(topology, node))] = 1;
      const auto at = [&](int local) {
        return vertex_of_[static_cast<std::size_t>(face[static_cast<std::size_t>(local)])];
      };
      with_face_element<E>(face.size(), [&]<TriangulatedFace F>() {
        for (const auto& [a, b, c] : F::triangles) {
          triangles_.push_back({at(a), at(b), at(c)});
          elements_.push_back(f.element);
        }
      });
    }
  }

  const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  /// Element behind every triangle.
  const std::vector<Index>& elements() const noexcept { return elements_; }
  /// Node of every vertex.
  const std::vector<NodeId>& nodes() const noexcept { return nodes_; }
  /// True if a vertex is still on a triangle.
  bool is_used(std::size_t vertex) const noexcept { return used_[vertex] != 0; }
  const std::vector<ElementFace>& faces() const noexcept { return faces_; }

 private:
  int add(const CutTopology<E>& topology, NodeId node) {
    vertex_of_.resize(topology.mesh().positions.size(), -1);
    int& vertex = vertex_of_[static_cast<std::size_t>(node)];
    if (vertex < 0) {
      vertex = static_cast<int>(nodes_.size());
      nodes_.push_back(node);
      used_.push_back(0);
    }
    return vertex;
  }

  std::vector<ElementFace> faces_;
  std::vector<NodeId> nodes_;
  std::vector<int> vertex_of_;
  std::vector<char> used_;
  std::vector<Triangle> triangles_;
  std::vector<Index> elements_;
};

}}  // namespace palpate
