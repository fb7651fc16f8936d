// The dofs that a cut changes, and the change of their stiffness.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_base.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/element_changes.hpp>
#include <palpate/cut/detail/kept_dofs.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/local/stiffness.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The small linear problem of one cut. Refers to the arguments of its constructor.
template <Element E>
class CutPlan {
 public:
  using Pin = typename ElementChanges<E>::Pin;

  /// `displacement`: of all nodes before the cut, three per node.
  CutPlan(const CutTopology<E>& topology, const TopologyChange<E>& of, const CutPhysics<E>& physics,
          const CutBase<E>& base, const KeptDofs& kept, const VectorX& displacement)
      : change(&of), topology_(&topology), physics_(&physics), kept_(&kept) {
    add_pins(topology, displacement);
    std::vector<NodeId> nodes;
    for (const ChangedElement<E>& x : change->elements)
      for (const auto* list : {&x.before, &x.after}) nodes.insert(nodes.end(), list->begin(), list->end());
    for (const Pin& pin : pins) nodes.push_back(pin.node);
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const bool is_fresh : {false, true})
      for (const NodeId node : nodes)
        if ((3 * Index{node} >= displacement.size()) == is_fresh) number_dofs(node, is_fresh, topology, base);
  }

  /// Assembles the change of the stiffness over the changed dofs, followed by the fresh ones.
  MatrixX assemble() const {
    const auto size = static_cast<Index>(changed.size() + fresh.size());
    MatrixX all = MatrixX::Zero(size, size);
    const Index first_fresh = kept_->size() + static_cast<Index>(promoted.size());
    std::map<Index, Index> row;
    for (std::size_t k = 0; k < changed.size(); ++k) row[changed[k]] = static_cast<Index>(k);
    const auto find = [&](NodeId node, int c) -> Index {
      const auto known = places_.find(node);
      const Index p = known != places_.end() ? known->second[static_cast<std::size_t>(c)] : kept_->index_of(node, c);
      if (p < 0) return -1;
      return p >= first_fresh ? p - first_fresh + static_cast<Index>(changed.size()) : row.at(p);
    };
    for (const ChangedElement<E>& x : change->elements) {
      const auto add = [&](const auto& nodes, const ElementPart<E>& part, double sign) {
        const ElementStiffness<E> k = physics_->stiffness(part);
        const auto at = ElementChanges<E>::indices_of(nodes, find);
        for (std::size_t i = 0; i < at.size(); ++i)
          for (std::size_t j = 0; j < at.size(); ++j)
            if (at[i] >= 0 && at[j] >= 0) all(at[i], at[j]) += sign * k(static_cast<Index>(i), static_cast<Index>(j));
      };
      if (!x.added) add(x.before, x.was, -1.0);
      if (!x.removed) add(x.after, topology_->part(x.element), 1.0);
    }
    for (const Pin& pin : pins)
      for (int c = 0; c < 3; ++c)
        if (const Index p = find(pin.node, c); p >= 0) all(p, p) += pin.stiffness;
    return all;
  }

  const TopologyChange<E>* change;
  std::vector<Pin> pins;          ///< springs for parts that this cut leaves unsupported
  std::vector<NodeDof> promoted;  ///< changed dofs that were not kept
  std::vector<NodeDof> fresh;     ///< new dofs
  std::vector<Index> changed;     ///< places of changed dofs that exist already; promoted ones follow the kept ones

 private:
  /// Pins all nodes of one element of each fragment, and nodes without elements.
  void add_pins(const CutTopology<E>& topology, const VectorX& displacement) {
    const auto pin = [&](NodeId node, double stiffness) {
      NodeId known = node;
      while (3 * Index{known} >= displacement.size()) known = topology.copied_from(known);
      pins.push_back({node, stiffness, displacement.template segment<3>(3 * Index{known})});
    };
    for (const Fragment& fragment : change->fragments) {
      Index best = fragment.elements.front();
      int most = -1;
      for (const Index e : fragment.elements) {
        int known = 0;
        for (const NodeId node : topology.mesh().elements[static_cast<std::size_t>(e)])
          if (kept_->index_of(node, 0) >= 0 || 3 * Index{node} >= displacement.size()) ++known;
        if (known > most) best = e, most = known;
      }
      const double stiffness = mean_stiffness(topology.part(best));
      for (const NodeId node : topology.mesh().elements[static_cast<std::size_t>(best)]) pin(node, stiffness);
    }
    for (const NodeId node : change->bare_nodes)
      for (const ChangedElement<E>& x : change->elements)
        if (!x.added && std::ranges::find(x.before, node) != x.before.end()) {
          pin(node, mean_stiffness(x.was));
          break;
        }
  }
  double mean_stiffness(const ElementPart<E>& part) const {
    return physics_->stiffness(part).trace() / (3.0 * E::nodes);
  }
  /// Numbers the dofs of a changed or new node.
  void number_dofs(NodeId node, bool is_fresh, const CutTopology<E>& topology, const CutBase<E>& base) {
    std::array<Index, 3> own{-1, -1, -1};
    bool added = false;
    for (int c = 0; c < 3; ++c) {
      Index p = kept_->index_of(node, c);
      const bool is_free = (topology.constrained()[static_cast<std::size_t>(node)] >> c & 1u) == 0;
      if (p < 0 && is_free && (is_fresh || base.index_of(node, c) >= 0)) {
        p = kept_->size() + static_cast<Index>(promoted.size() + fresh.size());
        (is_fresh ? fresh : promoted).push_back({node, c});
        added = true;
      }
      own[static_cast<std::size_t>(c)] = p;
      if (!is_fresh && p >= 0) changed.push_back(p);
    }
    if (added) places_[node] = own;
  }

  const CutTopology<E>* topology_;
  const CutPhysics<E>* physics_;
  const KeptDofs* kept_;
  std::map<NodeId, std::array<Index, 3>> places_;  // of nodes with promoted or fresh dofs
};

}}}  // namespace palpate::detail
