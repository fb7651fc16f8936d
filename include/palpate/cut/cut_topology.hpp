// A mesh under cuts: elements are removed, faces open, fragments come off.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/detail/face_ids.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// State of an element.
enum class ElementState : std::uint8_t { supported, detached, removed };

/// A mesh under a sequence of cuts. Ids of nodes and elements never change: nodes created by a cut are appended, and
/// removed elements keep their id. Elements never change their shape, so no cut makes a sliver.
///
/// After every cut the elements around a node are connected by faces that contain it; otherwise the node is split, one
/// copy per part (as in Serby et al. 2001 and Lindblad and Turkiyyah 2007, here for all kinds of cuts). So no two parts
/// are connected only by a node or an edge, and there are no hinges: parts joined by a face are joined rigidly, and a
/// fragment can move as a whole or not at all. Unsupported parts are therefore found by counting, not by a failing
/// solve.
template <Element E>
class CutTopology {
 public:
  static constexpr std::size_t faces = E::faces.size();
  using Connectivity = typename Mesh<E>::Connectivity;

  /// `constrained` has bit c set if component c of a node is prescribed; copies inherit it. Splits nodes at which parts
  /// of the given mesh touch. Throws non_manifold. O(elements log elements).
  CutTopology(Mesh<E> mesh, std::vector<std::uint8_t> constrained)
      : mesh_(std::move(mesh)), constrained_(std::move(constrained)) {
    if (constrained_.size() != mesh_.positions.size())
      raise(SetupErrorKind::bad_argument, "nodes and constraints differ in number");
    find_neighbours();
    find_stars();
    list_group_faces();
    parent_.resize(mesh_.positions.size());
    std::iota(parent_.begin(), parent_.end(), NodeId{0});
    copied_from_ = parent_;
    state_.assign(static_cast<std::size_t>(mesh_.element_count()), ElementState::supported);
    detail::TopologyChange<E> split;
    for (NodeId node = 0, count = static_cast<NodeId>(mesh_.node_count()); node < count; ++node)
      split_star(node, split);
    detach(split);
  }

  /// Applies an order. Throws index_out_of_range before any change. O(elements) to find fragments, little else.
  detail::TopologyChange<E> apply(const CutOrder& order) {
    require_valid(order);
    detail::TopologyChange<E> change;
    std::vector<NodeId> affected;
    for (const Index e : order.remove) remove(e, affected, change);
    for (const detail::ElementFace& f : order.open) open(f, affected);
    std::ranges::sort(affected);
    affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
    for (const NodeId node : affected) split_star(node, change);
    for (const detail::ChangedElement<E>& x : change.elements)
      for (const NodeId node : x.before)
        if (star_[at(node)].empty() && std::exchange(bare_[at(node)], 1) == 0) change.bare_nodes.push_back(node);
    expose_welded(change);
    std::ranges::sort(change.elements, {}, &detail::ChangedElement<E>::element);
    if (!change.elements.empty()) detach(change);
    return change;
  }

  /// The mesh with all ids, including removed elements, which keep their nodes.
  const Mesh<E>& mesh() const noexcept { return mesh_; }
  ElementState state(Index e) const noexcept { return state_[at(e)]; }
  bool is_removed(Index e) const noexcept { return state(e) == ElementState::removed; }
  const std::vector<std::uint8_t>& constrained() const noexcept { return constrained_; }
  /// The node of the given mesh from which a node was copied; itself if it is not a copy.
  NodeId origin_of(NodeId node) const noexcept { return parent_[at(node)]; }
  /// The node from which a node was split; itself if it was not split.
  NodeId copied_from(NodeId node) const noexcept { return copied_from_[at(node)]; }
  /// Elements around a node, without removed ones.
  const std::vector<Index>& elements_at(NodeId node) const noexcept { return star_[at(node)]; }
  /// Neighbour element across a face, -1 on the surface and at an open face.
  Index neighbour(Index e, std::size_t face) const noexcept { return neighbour_[at(e)][face]; }
  /// Nodes of a face, outward.
  detail::FaceIds<E> face_nodes(const detail::ElementFace& f) const {
    return detail::face_ids<E>(mesh_, f.element, static_cast<std::size_t>(f.face));
  }
  /// Volume [m^3] by the element's quadrature.
  double volume(Index e) const { return element_shape<E>(element_nodes<E>(mesh_, e)).volume; }
  const std::vector<detail::Fragment>& detached_fragments() const noexcept { return detached_; }

  /// The part in one state as a separate mesh, with groups and regions. `node_map` gets the new id of every node, -1 if
  /// it is not included; `element_map` the id in this topology of every element of the part.
  Mesh<E> extract(ElementState wanted, std::vector<NodeId>& node_map, std::vector<Index>& element_map) const {
    Mesh<E> part;
    element_map.clear();
    node_map.assign(mesh_.positions.size(), -1);
    for (Index e = 0; e < mesh_.element_count(); ++e) {
      if (state(e) != wanted) continue;
      element_map.push_back(e);
      for (const NodeId node : mesh_.elements[at(e)]) node_map[at(node)] = 0;
    }
    for (std::size_t i = 0; i < node_map.size(); ++i)
      if (node_map[i] == 0) {
        node_map[i] = static_cast<NodeId>(part.positions.size());
        part.positions.push_back(mesh_.positions[i]);
      }
    for (const Index e : element_map) {
      Connectivity nodes = mesh_.elements[at(e)];
      for (NodeId& node : nodes) node = node_map[at(node)];
      part.elements.push_back(nodes);
      part.regions.push_back(mesh_.region(e));
      if (mesh_.has_fibres()) part.fibres.push_back(mesh_.fibre(e));
    }
    part.region_names = mesh_.region_names;
    copy_groups(node_map, element_map, part);
    return part;
  }

 private:
  static constexpr std::size_t at(Index i) noexcept { return static_cast<std::size_t>(i); }

  void require_valid(const CutOrder& order) const {
    std::vector<std::int64_t> bad;
    const auto outside = [&](Index e) { return e < 0 || e >= mesh_.element_count(); };
    for (const Index e : order.remove)
      if (outside(e)) bad.push_back(e);
    for (const detail::ElementFace& f : order.open)
      if (outside(f.element) || f.face < 0 || f.face >= static_cast<int>(faces)) bad.push_back(f.element);
    if (bad.empty()) return;
    SetupProblem p;
    p.kind = SetupErrorKind::index_out_of_range;
    p.what = "a cut refers to elements or faces that do not exist";
    p.hint = "Elements are 0 ... " + std::to_string(mesh_.element_count() - 1);
    p.set_ids(bad, SetupIds::elements);
    raise(std::move(p));
  }

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
    bare_.assign(mesh_.positions.size(), 0);
    for (Index e = 0; e < mesh_.element_count(); ++e)
      for (const NodeId node : mesh_.elements[at(e)]) star_[at(node)].push_back(e);
  }
  /// The face of element e towards `other`, -1 if they share no face.
  int face_towards(Index e, Index other) const noexcept {
    for (std::size_t f = 0; f < faces; ++f)
      if (neighbour_[at(e)][f] == other) return static_cast<int>(f);
    return -1;
  }

  void remove(Index e, std::vector<NodeId>& affected, detail::TopologyChange<E>& change) {
    if (is_removed(e)) return;
    for (std::size_t f = 0; f < faces; ++f) {
      const Index other = neighbour_[at(e)][f];
      if (other < 0) continue;
      const int back = face_towards(other, e);
      neighbour_[at(other)][at(back)] = neighbour_[at(e)][f] = -1;
      change.exposed.push_back({other, back});
    }
    const Connectivity& nodes = mesh_.elements[at(e)];
    for (const NodeId node : nodes) {
      std::erase(star_[at(node)], e);
      affected.push_back(node);
    }
    auto& list = state(e) == ElementState::supported ? change.elements : change.detached_elements;
    list.push_back({e, nodes, nodes, true});
    state_[at(e)] = ElementState::removed;
    std::erase_if(change.exposed, [e](const detail::ElementFace& x) { return x.element == e; });
  }

  void open(const detail::ElementFace& f, std::vector<NodeId>& affected) {
    const Index other = neighbour_[at(f.element)][at(f.face)];
    if (other < 0) return;
    const int back = face_towards(other, f.element);
    neighbour_[at(f.element)][at(f.face)] = neighbour_[at(other)][at(back)] = -1;
    welded_.push_back({f, {other, back}});
    for (const NodeId node : face_nodes(f)) affected.push_back(node);
  }

  /// Splits a node whose elements are not connected by faces at it. The part with the most elements keeps the node; of
  /// equal ones the one with the lowest element.
  void split_star(NodeId node, detail::TopologyChange<E>& change) {
    const auto parts = detail::star_parts(*this, node);
    if (parts.size() < 2) return;
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const auto copy = static_cast<NodeId>(mesh_.positions.size());
      mesh_.positions.push_back(mesh_.position(node));
      constrained_.push_back(constrained_[at(node)]);
      parent_.push_back(parent_[at(node)]);
      copied_from_.push_back(node);
      bare_.push_back(0);
      change.copies.push_back({copy, node});
      for (const Index e : parts[k]) reconnect(e, node, copy, change);
      star_.push_back(parts[k]);
    }
    star_[at(node)] = parts[0];
  }
  void reconnect(Index e, NodeId from, NodeId to, detail::TopologyChange<E>& change) {
    auto& list = state(e) == ElementState::supported ? change.elements : change.detached_elements;
    auto found = std::ranges::find(list, e, &detail::ChangedElement<E>::element);
    if (found == list.end()) found = list.insert(list.end(), {e, mesh_.elements[at(e)], {}, false});
    std::ranges::replace(mesh_.elements[at(e)], from, to);
    found->after = mesh_.elements[at(e)];
  }

  /// Exposes open faces whose two sides no longer share all nodes; until then they are not part of the surface.
  void expose_welded(detail::TopologyChange<E>& change) {
    std::erase_if(welded_, [&](const std::array<detail::ElementFace, 2>& sides) {
      const bool gone0 = is_removed(sides[0].element), gone1 = is_removed(sides[1].element);
      if (!gone0 && !gone1) {
        auto a = face_nodes(sides[0]), b = face_nodes(sides[1]);
        std::ranges::sort(a);
        std::ranges::sort(b);
        if (a == b) return false;
      }
      if (!gone0) change.exposed.push_back(sides[0]);
      if (!gone1) change.exposed.push_back(sides[1]);
      return true;
    });
  }

  /// Finds and detaches the fragments without support.
  void detach(detail::TopologyChange<E>& change) {
    for (detail::Fragment& fragment : detail::unsupported_fragments(*this)) {
      for (const Index e : fragment.elements) state_[at(e)] = ElementState::detached;
      detached_.push_back(fragment);
      change.fragments.push_back(std::move(fragment));
    }
  }

  /// Stores the faces of groups by element, because they move with it.
  void list_group_faces() {
    const std::vector<detail::KeyedFace<E>> all = detail::sorted_faces<E>(mesh_);
    for (const Group& g : mesh_.groups.all()) {
      auto& list = group_faces_.emplace_back();
      for (const auto& nodes : g.faces) {
        if (!detail::is_face_size<E>(nodes.size())) continue;
        detail::FaceIds<E> key = detail::make_face_ids<E>(nodes.size());
        std::ranges::copy(nodes, key.begin());
        std::ranges::sort(key);
        const auto found = std::ranges::lower_bound(all, key, {}, &detail::KeyedFace<E>::key);
        if (found != all.end() && found->key == key) list.push_back({found->element, found->local});
      }
    }
  }
  void copy_groups(const std::vector<NodeId>& node_map, const std::vector<Index>& element_map, Mesh<E>& part) const {
    std::vector<Index> place(at(mesh_.element_count()), -1);
    for (std::size_t k = 0; k < element_map.size(); ++k) place[at(element_map[k])] = static_cast<Index>(k);
    for (std::size_t g = 0; g < mesh_.groups.all().size(); ++g) {
      const Group& from = mesh_.groups.all()[g];
      Group& to = part.groups.get_or_add(from.name, from.dimension);
      for (std::size_t i = 0; i < node_map.size(); ++i)
        if (node_map[i] >= 0 && std::ranges::binary_search(from.nodes, parent_[i])) to.nodes.push_back(node_map[i]);
      for (const detail::ElementFace& f : group_faces_[g]) {
        if (place[at(f.element)] < 0) continue;
        std::vector<NodeId> nodes;
        for (const NodeId node : face_nodes(f)) nodes.push_back(node_map[at(node)]);
        to.faces.push_back(std::move(nodes));
      }
      for (const Index e : from.elements)
        if (place[at(e)] >= 0) to.elements.push_back(place[at(e)]);
    }
    part.groups.tidy();
  }

  Mesh<E> mesh_;
  std::vector<std::uint8_t> constrained_, bare_;
  std::vector<std::array<Index, faces>> neighbour_;
  std::vector<std::vector<Index>> star_;
  std::vector<NodeId> parent_, copied_from_;
  std::vector<ElementState> state_;
  std::vector<std::array<detail::ElementFace, 2>> welded_;
  std::vector<detail::Fragment> detached_;
  std::vector<std::vector<detail::ElementFace>> group_faces_;
};

namespace detail {

/// All cuts between two states of one topology as a single change, for the part that was supported in `then`.
/// O(elements).
template <Element E>
TopologyChange<E> difference(const CutTopology<E>& then, const CutTopology<E>& now) {
  TopologyChange<E> change;
  const auto old = static_cast<NodeId>(then.mesh().node_count());
  const auto was_supported = [&](Index e) { return then.state(e) == ElementState::supported; };
  for (Index e = 0; e < now.mesh().element_count(); ++e) {
    if (!was_supported(e)) continue;
    const auto& before = then.mesh().elements[static_cast<std::size_t>(e)];
    const auto& after = now.mesh().elements[static_cast<std::size_t>(e)];
    if (now.is_removed(e))
      change.elements.push_back({e, before, before, true});
    else if (before != after)
      change.elements.push_back({e, before, after, false});
  }
  for (NodeId node = old; node < now.mesh().node_count(); ++node) {
    NodeId parent = node;
    while (parent >= old) parent = now.copied_from(parent);
    change.copies.push_back({node, parent});
  }
  for (const ChangedElement<E>& x : change.elements)
    for (const NodeId node : x.before)
      if (now.elements_at(node).empty()) change.bare_nodes.push_back(node);
  std::ranges::sort(change.bare_nodes);
  const auto repeated = std::unique(change.bare_nodes.begin(), change.bare_nodes.end());
  change.bare_nodes.erase(repeated, change.bare_nodes.end());
  change.fragments =
      connected_fragments(now, [&](Index e) { return was_supported(e) && now.state(e) == ElementState::detached; });
  return change;
}

}  // namespace detail

}}  // namespace palpate
