// The touchable surface of a body that is cut.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <tuple>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Faces that a tool may touch and the vertices of their nodes. Before any cut both are those of resolve_touchable, in
/// the same order. Vertices keep their numbers: new ones are appended, and those of removed parts stay at their
/// position, without a triangle. Faces exposed by a cut are touchable from then on.
template <Element E>
class CutSurface {
 public:
  CutSurface() = default;
  /// Resolves the touchable faces of a scene. Throws as resolve_touchable.
  CutSurface(const CutTopology<E>& topology, const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    const Mesh<E>& mesh = topology.mesh();
    const Touchable touchable = resolve_touchable(mesh_ref(mesh), boundary, scene);
    for (const NodeId node : touchable.nodes) add(topology, node);
    const auto given = [&](NodeId node) { return topology.origin_of(node); };  // the boundary is that of the given mesh
    for (const BoundaryFace& f : touchable.faces)
      for (std::size_t local = 0; local < E::faces.size(); ++local)
        if (std::ranges::equal(topology.face_nodes({f.element, static_cast<int>(local)}), f.nodes, {}, given))
          faces_.push_back({f.element, static_cast<int>(local)});
    std::vector<ElementFace> sorted = faces_;
    std::ranges::sort(sorted, less);
    for (Index e = 0; e < mesh.element_count(); ++e)
      for (std::size_t local = 0; local < E::faces.size(); ++local)
        if (const ElementFace f{e, static_cast<int>(local)};
            topology.neighbour(e, local) < 0 && !std::ranges::binary_search(sorted, f, less))
          others_.push_back(f);
    update(topology, {});
  }

  /// Applies a cut: adds exposed faces and split nodes, drops removed faces. O(boundary faces).
  void update(const CutTopology<E>& topology, const TopologyChange<E>& change) {
    for (const FollowedFace& followed : change.followed)
      for (auto* list : {&faces_, &others_}) follow(followed, *list);
    faces_.insert(faces_.end(), change.exposed.begin(), change.exposed.end());
    const auto is_gone = [&](const ElementFace& f) { return topology.state(f.element) != ElementState::supported; };
    std::erase_if(faces_, is_gone);
    std::erase_if(others_, is_gone);
    triangles_.clear();
    elements_.clear();
    used_.assign(nodes_.size(), 0);
    for (const ElementFace& f : faces_) {
      const auto face = topology.face_nodes(f);
      for (const NodeId node : face) used_[static_cast<std::size_t>(add(topology, node))] = 1;
      add_triangles(face, vertex_of_, triangles_);
      elements_.resize(triangles_.size(), f.element);
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

  /// The boundary that cannot be touched.
  struct Shell {
    std::vector<Triangle> triangles;  ///< outward; an index k >= nodes().size() means others[k - nodes().size()]
    std::vector<NodeId> others;       ///< nodes that are not those of a vertex
  };
  /// O(nodes) unless all of the boundary can be touched.
  Shell shell(const CutTopology<E>& topology) const {
    Shell shell;
    if (others_.empty()) return shell;
    std::vector<int> place = vertex_of_;
    place.resize(topology.mesh().positions.size(), -1);
    for (const ElementFace& f : others_) {
      const auto face = topology.face_nodes(f);
      for (const NodeId node : face) {
        int& own = place[static_cast<std::size_t>(node)];
        if (own >= 0) continue;
        own = static_cast<int>(nodes_.size() + shell.others.size());
        shell.others.push_back(node);
      }
      add_triangles(face, place, shell.triangles);
    }
    return shell;
  }

 private:
  static bool less(const ElementFace& a, const ElementFace& b) noexcept {
    return std::tie(a.element, a.face) < std::tie(b.element, b.face);
  }
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
  static void add_triangles(const FaceIds<E>& face, const std::vector<int>& vertex_of, std::vector<Triangle>& to) {
    const auto at = [&](int local) {
      return vertex_of[static_cast<std::size_t>(face[static_cast<std::size_t>(local)])];
    };
    with_face_element<E>(face.size(), [&]<TriangulatedFace F>() {
      for (const auto& [a, b, c] : F::triangles) to.push_back({at(a), at(b), at(c)});
    });
  }

  std::vector<ElementFace> faces_, others_;
  std::vector<NodeId> nodes_;
  std::vector<int> vertex_of_;
  std::vector<char> used_;
  std::vector<Triangle> triangles_;
  std::vector<Index> elements_;
};

}}}  // namespace palpate::detail
