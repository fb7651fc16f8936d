// A mesh under cuts: elements are removed, faces open, fragments come off.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/element_graph.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/detail/face_ids.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A mesh under a sequence of cuts. Ids of nodes and elements never change: those created by a cut are appended, and
/// removed elements keep their id.
///
/// After every cut the elements around a node are connected by faces that contain it; otherwise the node is split, one
/// copy per part (as in Serby et al. 2001 and Lindblad and Turkiyyah 2007, here for all kinds of cuts). So no two parts
/// are connected only by a node or an edge, and there are no hinges: parts joined by a face are joined rigidly, and a
/// fragment can move as a whole or not at all. Unsupported parts are therefore found by counting, not by a failing
/// solve.
template <Element E>
class CutTopology : public detail::ElementGraph<E> {
 public:
  using Graph = detail::ElementGraph<E>;
  using Graph::face_nodes;
  using Graph::faces;
  using Graph::is_removed;
  using Graph::mesh;
  using Graph::origin_of;
  using Graph::origin_of_element;
  using Graph::state;
  using typename Graph::Connectivity;

  /// `constrained` has bit c set if component c of a node is prescribed; copies inherit it. Splits nodes at which parts
  /// of the given mesh touch. Throws non_manifold. O(elements log elements).
  CutTopology(Mesh<E> given, std::vector<std::uint8_t> constrained)
      : Graph(std::move(given), std::move(constrained)), bare_(mesh_.positions.size(), 0) {
    list_group_faces();
    detail::TopologyChange<E> split;
    for (NodeId node = 0, count = static_cast<NodeId>(mesh_.node_count()); node < count; ++node)
      split_star(node, split);
    detach(split);
  }

  /// Applies an order. Throws as `apply_all`. O(elements) to find fragments, little else.
  detail::TopologyChange<E> apply(const CutOrder& order) {
    return apply_all([&](auto&& apply_one) { apply_one(order); });
  }
  /// Applies several orders as one cut: `orders(apply_one)` calls `apply_one(order)` for each CutOrder or
  /// detail::ReshapingOrder, and may look at what the last one has made of this topology. Nodes are split after all of
  /// them. Throws index_out_of_range before the change by the order that refers to what does not exist.
  template <class Orders>
  detail::TopologyChange<E> apply_all(Orders&& orders) {
    detail::TopologyChange<E> change;
    std::vector<NodeId> affected;
    orders([&]<class Order>(const Order& order) {
      require_valid(order);
      if constexpr (std::same_as<Order, detail::ReshapingOrder>) {
        for (const detail::MovedNode& moved : order.move) this->move(moved, change);
        for (const detail::DividedEdge& edge : order.divide) divide(edge, change);
      }
      for (const Index e : order.remove) remove(e, affected, change);
      for (const detail::ElementFace& f : order.open) open(f, affected);
    });
    std::ranges::sort(affected);
    affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
    for (const NodeId node : affected) split_star(node, change);
    bare_.resize(star_.size(), 0);
    for (const detail::ChangedElement<E>& x : change.elements)
      for (const NodeId node : x.before)
        if (star_[at(node)].empty() && std::exchange(bare_[at(node)], 1) == 0) change.bare_nodes.push_back(node);
    expose_welded(change);
    std::ranges::sort(change.elements, {}, &detail::ChangedElement<E>::element);
    if (!change.elements.empty()) detach(change);
    return change;
  }

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
  using Graph::add_node;
  using Graph::at;
  using Graph::changed;
  using Graph::constrained_;
  using Graph::face_towards;
  using Graph::mesh_;
  using Graph::neighbour_;
  using Graph::star_;
  using Graph::state_;
  using Graph::walls_;

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

  void set_wall(const detail::ElementFace& f) {
    walls_[at(f.element)] = static_cast<std::uint8_t>(walls_[at(f.element)] | 1u << f.face);
  }
  /// The lists of faces follow the halves of divided elements.
  void divide(const detail::DividedEdge& edge, detail::TopologyChange<E>& change) {
    const std::size_t known = change.followed.size();
    Graph::divide(edge, change);
    for (std::size_t k = known; k < change.followed.size(); ++k) {
      const detail::FollowedFace& followed = change.followed[k];
      detail::follow(followed, change.exposed);
      for (auto& list : group_faces_) detail::follow(followed, list);
      for (auto& sides : welded_)
        for (detail::ElementFace& f : sides)
          if (!followed.is_half && f == followed.from) f = followed.to;  // its edges are not divisible
    }
  }
  void remove(Index e, std::vector<NodeId>& affected, detail::TopologyChange<E>& change) {
    if (is_removed(e)) return;
    for (std::size_t f = 0; f < faces; ++f) {
      const Index other = neighbour_[at(e)][f];
      if (other < 0) continue;
      const int back = face_towards(other, e);
      neighbour_[at(other)][at(back)] = neighbour_[at(e)][f] = -1;
      set_wall({other, back});
      change.exposed.push_back({other, back});
    }
    for (const NodeId node : mesh_.elements[at(e)]) {
      std::erase(star_[at(node)], e);
      affected.push_back(node);
    }
    changed(e, change).removed = true;
    state_[at(e)] = ElementState::removed;
    std::erase_if(change.exposed, [e](const detail::ElementFace& x) { return x.element == e; });
  }

  void open(const detail::ElementFace& f, std::vector<NodeId>& affected) {
    const Index other = neighbour_[at(f.element)][at(f.face)];
    if (other < 0) return;
    const int back = face_towards(other, f.element);
    neighbour_[at(f.element)][at(f.face)] = neighbour_[at(other)][at(back)] = -1;
    welded_.push_back({f, {other, back}});
    set_wall(f);
    set_wall({other, back});
    for (const NodeId node : face_nodes(f)) affected.push_back(node);
  }

  /// Splits a node whose elements are not connected by faces at it. The part with the most elements keeps the node; of
  /// equal ones the one with the lowest element.
  void split_star(NodeId node, detail::TopologyChange<E>& change) {
    const auto parts = detail::star_parts(*this, node);
    if (parts.size() < 2) return;
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const NodeId copy = add_node(mesh_.position(node), node, constrained_[at(node)], change);
      for (const Index e : parts[k]) reconnect(e, node, copy, change);
      star_[at(copy)] = parts[k];
    }
    star_[at(node)] = parts[0];
  }
  void reconnect(Index e, NodeId from, NodeId to, detail::TopologyChange<E>& change) {
    detail::ChangedElement<E>& entry = changed(e, change);
    std::ranges::replace(mesh_.elements[at(e)], from, to);
    entry.after = mesh_.elements[at(e)];
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
        if (node_map[i] >= 0 && !this->is_made(static_cast<NodeId>(i)) &&
            std::ranges::binary_search(from.nodes, origin_of(static_cast<NodeId>(i))))
          to.nodes.push_back(node_map[i]);
      for (const detail::ElementFace& f : group_faces_[g]) {
        if (place[at(f.element)] < 0) continue;
        std::vector<NodeId> nodes;
        for (const NodeId node : face_nodes(f)) nodes.push_back(node_map[at(node)]);
        to.faces.push_back(std::move(nodes));
      }
      for (std::size_t k = 0; k < element_map.size(); ++k)
        if (std::ranges::binary_search(from.elements, origin_of_element(element_map[k])))
          to.elements.push_back(static_cast<Index>(k));
    }
    part.groups.tidy();
  }

  std::vector<std::uint8_t> bare_;
  std::vector<std::array<detail::ElementFace, 2>> welded_;
  std::vector<detail::Fragment> detached_;
  std::vector<std::vector<detail::ElementFace>> group_faces_;
};

}}  // namespace palpate
