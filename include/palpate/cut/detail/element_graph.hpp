// The elements of a mesh under cuts, with their neighbours and the elements around every node.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/detail/face_ids.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// State of an element.
enum class ElementState : std::uint8_t { supported, detached, removed };

namespace detail {

/// Elements that can be divided, so that cuts follow the sheet of a blade.
template <Element E>
inline constexpr bool follows_sheets = E::nodes == 4 && E::order == 1;

/// A mesh whose nodes are moved and split, and whose elements are divided. Ids of nodes and elements never change:
/// those created by a cut are appended, and removed elements keep their id. Base of CutTopology.
template <Element E>
class ElementGraph {
 public:
  static constexpr std::size_t faces = E::faces.size();
  using Connectivity = typename Mesh<E>::Connectivity;

  /// The mesh with all ids, including removed elements, which keep their nodes.
  const Mesh<E>& mesh() const noexcept { return mesh_; }
  ElementState state(Index e) const noexcept { return state_[at(e)]; }
  bool is_removed(Index e) const noexcept { return state(e) == ElementState::removed; }
  const std::vector<std::uint8_t>& constrained() const noexcept { return constrained_; }
  /// The node of the given mesh from which a node was made; itself if it is given.
  NodeId origin_of(NodeId node) const noexcept { return origin_[at(node)]; }
  /// The element of the given mesh of which an element is a part; itself if it is given.
  Index origin_of_element(Index e) const noexcept {
    while (divided_from(e) != e) e = divided_from(e);
    return e;
  }
  /// An element with its present shape.
  ElementPart<E> part(Index e) const { return {origin_of_element(e), element_nodes<E>(mesh_, e), given_faces_[at(e)]}; }
  /// The element that was divided to make an element; itself if it is given.
  Index divided_from(Index e) const noexcept { return divided_from_[at(e)]; }
  /// The node from which a node was split, or an end of the edge on which it was made; itself if it is given.
  NodeId copied_from(NodeId node) const noexcept { return copied_from_[at(node)]; }
  /// Elements around a node, without removed ones.
  const std::vector<Index>& elements_at(NodeId node) const noexcept { return star_[at(node)]; }
  /// Neighbour element across a face, -1 on the surface and at an open face.
  Index neighbour(Index e, std::size_t face) const noexcept { return neighbour_[at(e)][face]; }
  /// Elements around the edge between two nodes.
  std::vector<Index> elements_around(NodeId from, NodeId to) const {
    std::vector<Index> found;
    for (const Index e : elements_at(from))
      if (contains(mesh_.elements[at(e)], to)) found.push_back(e);
    return found;
  }
  /// Whether the elements around an edge can be divided: they are supported tetrahedra, the edge has an end that is
  /// free, and no face with it is open but still closed on both sides (CutTopology).
  bool is_divisible(NodeId from, NodeId to) const {
    if (!follows_sheets<E> || (constrained_[at(from)] != 0 && constrained_[at(to)] != 0)) return false;
    const std::vector<Index> ring = elements_around(from, to);
    return !ring.empty() && std::ranges::all_of(ring, [&](Index e) {
      for (std::size_t f = 0; f < faces; ++f) {
        if (neighbour(e, f) >= 0) continue;
        const auto nodes = face_nodes({e, static_cast<int>(f)});
        if (contains(nodes, from) && contains(nodes, to) && count_with(ring, nodes) > 1) return false;
      }
      return state(e) == ElementState::supported;
    });
  }
  /// Whether a node was made on an edge, or is a copy of one that was.
  bool is_made(NodeId node) const noexcept { return at(node) < made_.size() && made_[at(node)] != 0; }
  /// Whether a cut has moved a node.
  bool is_moved(NodeId node) const noexcept { return at(node) < moved_.size() && moved_[at(node)] != 0; }
  /// Whether a cut has opened a face at a node.
  bool is_on_wall(NodeId node) const {
    return std::ranges::any_of(elements_at(node), [&](Index e) {
      for (std::size_t f = 0; f < faces; ++f)
        if ((walls_[at(e)] >> f & 1u) != 0 && contains(face_nodes({e, static_cast<int>(f)}), node)) return true;
      return false;
    });
  }
  /// Nodes of a face, outward.
  detail::FaceIds<E> face_nodes(const detail::ElementFace& f) const {
    return detail::face_ids<E>(mesh_, f.element, static_cast<std::size_t>(f.face));
  }
  /// Volume [m^3] by the element's quadrature.
  double volume(Index e) const { return element_shape<E>(element_nodes<E>(mesh_, e)).volume; }
  /// ElementShape::quality.
  double quality(Index e) const { return element_shape<E>(element_nodes<E>(mesh_, e)).quality; }

 protected:
  /// Throws bad_argument, non_manifold. O(elements log elements).
  ElementGraph(Mesh<E> mesh, std::vector<std::uint8_t> constrained)
      : mesh_(std::move(mesh)), constrained_(std::move(constrained)) {
    if (constrained_.size() != mesh_.positions.size())
      raise(SetupErrorKind::bad_argument, "nodes and constraints differ in number");
    find_neighbours();
    find_stars();
    origin_.resize(mesh_.positions.size());
    std::iota(origin_.begin(), origin_.end(), NodeId{0});
    copied_from_ = origin_;
    state_.assign(at(mesh_.element_count()), ElementState::supported);
    walls_.assign(state_.size(), 0);
    given_faces_.assign(state_.size(), 0b111111);
    divided_from_.resize(state_.size());
    std::iota(divided_from_.begin(), divided_from_.end(), Index{0});
  }
  ~ElementGraph() = default;
  ElementGraph(const ElementGraph&) = default;
  ElementGraph(ElementGraph&&) = default;
  ElementGraph& operator=(const ElementGraph&) = default;
  ElementGraph& operator=(ElementGraph&&) = default;

  static constexpr std::size_t at(Index i) noexcept { return static_cast<std::size_t>(i); }
  template <class Ids, class Id>
  static bool contains(const Ids& ids, Id id) noexcept {
    return std::ranges::find(ids, id) != ids.end();
  }

  /// Number of elements among these with all of these nodes.
  template <class Nodes>
  Index count_with(const std::vector<Index>& elements, const Nodes& nodes) const noexcept {
    return std::ranges::count_if(elements, [&](Index e) {
      return std::ranges::all_of(nodes, [&](NodeId node) { return contains(mesh_.elements[at(e)], node); });
    });
  }
  /// The face of element e towards `other`, -1 if they share no face.
  int face_towards(Index e, Index other) const noexcept {
    for (std::size_t f = 0; f < faces; ++f)
      if (neighbour_[at(e)][f] == other) return static_cast<int>(f);
    return -1;
  }
  /// The entry of an element that is not removed yet; a new one has its present nodes and shape.
  detail::ChangedElement<E>& changed(Index e, detail::TopologyChange<E>& change) const {
    auto& list = state(e) == ElementState::supported ? change.elements : change.detached_elements;
    const auto found = std::ranges::find(list, e, &detail::ChangedElement<E>::element);
    if (found != list.end()) return *found;
    const Connectivity& nodes = mesh_.elements[at(e)];
    return list.emplace_back(detail::ChangedElement<E>{e, nodes, nodes, part(e), false, false});
  }
  void move(const MovedNode& moved, detail::TopologyChange<E>& change) {
    for (const Index e : star_[at(moved.node)]) changed(e, change);
    mesh_.positions[at(moved.node)] = moved.position;
    moved_.resize(mesh_.positions.size(), 0);
    moved_[at(moved.node)] = 1;
  }
  /// A new node; it has no elements yet.
  NodeId add_node(const Vector3& position, NodeId from, std::uint8_t constrained, detail::TopologyChange<E>& change) {
    const auto node = static_cast<NodeId>(mesh_.positions.size());
    mesh_.positions.push_back(position);
    constrained_.push_back(constrained);
    origin_.push_back(origin_[at(from)]);
    copied_from_.push_back(from);
    star_.emplace_back();
    made_.resize(star_.size(), 0);
    made_.back() = made_[at(from)];
    change.copies.push_back({node, from});
    return node;
  }
  /// Divides all elements around an edge by a new node on it, if it is divisible. They keep their ids for the halves at
  /// the first end.
  void divide(const DividedEdge& edge, TopologyChange<E>& change) {
    if (!is_divisible(edge.from, edge.to)) return;
    const std::vector<Index> ring = elements_around(edge.from, edge.to);
    const NodeId middle = add_node(edge.position, edge.from, 0, change);
    made_[at(middle)] = 1;
    std::vector<Index> second;  // the other halves
    for (const Index e : ring) second.push_back(halve(e, edge, middle, change));
    for (std::size_t k = 0; k < ring.size(); ++k)
      for (std::size_t f = 0; f < faces; ++f) {
        const auto nodes = face_nodes({ring[k], static_cast<int>(f)});
        if (!contains(nodes, edge.from) || !contains(nodes, middle)) continue;
        change.followed.push_back({{ring[k], static_cast<int>(f)}, {second[k], static_cast<int>(f)}, true});
        const auto next = std::ranges::find(ring, neighbour(ring[k], f));
        neighbour_[at(second[k])][f] = next != ring.end() ? second[static_cast<std::size_t>(next - ring.begin())] : -1;
      }
  }

  Mesh<E> mesh_;
  std::vector<std::uint8_t> constrained_;
  std::vector<std::uint8_t> walls_;  // per element, bit f is set where a cut has opened face f
  std::vector<std::array<Index, faces>> neighbour_;
  std::vector<std::vector<Index>> star_;
  std::vector<ElementState> state_;

 private:
  void find_neighbours() {
    extract_boundary<E>(mesh_);  // throws for faces of three elements
    neighbour_.assign(at(mesh_.element_count()), {});
    for (auto& n : neighbour_) n.fill(-1);
    const std::vector<detail::KeyedFace<E>> all = detail::sorted_faces<E>(mesh_);
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      if (all[i].key == all[i + 1].key) {
        neighbour_[at(all[i].element)][at(all[i].local)] = all[i + 1].element;
        neighbour_[at(all[i + 1].element)][at(all[i + 1].local)] = all[i].element;
      }
  }
  void find_stars() {
    star_.resize(mesh_.positions.size());
    for (Index e = 0; e < mesh_.element_count(); ++e)
      for (const NodeId node : mesh_.elements[at(e)]) star_[at(node)].push_back(e);
  }
  /// Adds an element with the nodes, neighbours and properties of another one.
  Index add_copy_of(Index e) {
    const auto fresh = static_cast<Index>(mesh_.elements.size());
    mesh_.elements.push_back(mesh_.elements[at(e)]);
    if (!mesh_.regions.empty()) mesh_.regions.push_back(mesh_.region(e));
    if (mesh_.has_fibres()) mesh_.fibres.push_back(mesh_.fibre(e));
    state_.push_back(state(e));
    neighbour_.push_back(neighbour_[at(e)]);
    divided_from_.push_back(e);
    given_faces_.push_back(given_faces_[at(e)]);
    walls_.push_back(walls_[at(e)]);
    return fresh;
  }
  Index halve(Index e, const DividedEdge& edge, NodeId middle, TopologyChange<E>& change) {
    std::size_t at_first = 0, at_second = 0;  // the faces that keep one end only
    for (std::size_t f = 0; f < faces; ++f) {
      const auto nodes = face_nodes({e, static_cast<int>(f)});
      if (!contains(nodes, edge.to)) at_first = f;
      if (!contains(nodes, edge.from)) at_second = f;
    }
    changed(e, change);
    const Index second = add_copy_of(e);
    std::ranges::replace(mesh_.elements[at(e)], edge.to, middle);
    std::ranges::replace(mesh_.elements[at(second)], edge.from, middle);
    changed(e, change).after = mesh_.elements[at(e)];
    change.elements.push_back({second, mesh_.elements[at(second)], mesh_.elements[at(second)], {}, false, true});
    for (const NodeId node : mesh_.elements[at(second)]) star_[at(node)].push_back(second);
    star_[at(middle)].push_back(e);
    std::erase(star_[at(edge.to)], e);
    if (const Index other = neighbour(e, at_second); other >= 0)
      neighbour_[at(other)][at(face_towards(other, e))] = second;
    neighbour_[at(e)][at_second] = second;
    neighbour_[at(second)][at_first] = e;
    change.followed.push_back({{e, static_cast<int>(at_second)}, {second, static_cast<int>(at_second)}, false});
    const auto made_at_first = static_cast<std::uint8_t>(~(1u << at_second)),
               made_at_second = static_cast<std::uint8_t>(~(1u << at_first));
    for (auto* const list : {&given_faces_, &walls_}) {
      (*list)[at(e)] &= made_at_first;
      (*list)[at(second)] &= made_at_second;
    }
    return second;
  }

  std::vector<char> moved_, made_;  // per node, those before the first such change may be missing
  std::vector<NodeId> origin_, copied_from_;
  std::vector<Index> divided_from_;
  std::vector<std::uint8_t> given_faces_;
};

}
}}  // namespace palpate::detail
