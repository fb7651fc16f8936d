// The changes of a stiffness by cuts since it was factorised, element by element.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Difference between the current stiffness and the factorised one: minus the changed elements, plus those of them that
/// still exist and their parts, on their current nodes and with their current shapes, plus springs on unsupported
/// parts. Dofs are looked up by `place(node, component)`, -1 for prescribed ones.
template <Element E>
class ElementChanges {
 public:
  using Values = Eigen::Matrix<double, 3 * E::nodes, 1>;
  using Places = std::array<Index, static_cast<std::size_t>(3 * E::nodes)>;
  using Connectivity = typename Mesh<E>::Connectivity;

  struct Changed {
    Connectivity before{}, now{};
    bool added = false, removed = false;        // it was not in the factor; it is not there now
    ElementStiffness<E> factorised, stiffness;  // in the factor, now
    Values factorised_load, load;
  };
  /// A spring to the position of a node at the moment it lost its support. It keeps the fragment's dofs in the system
  /// and has no effect on other parts.
  struct Pin {
    NodeId node = 0;
    double stiffness = 0.0;          ///< [N/m]
    Vector3 rest = Vector3::Zero();  ///< displacement without force [m]
  };

  bool empty() const noexcept { return changed_.empty() && pins_.empty(); }
  const std::vector<Pin>& pins() const noexcept { return pins_; }

  /// `part`: as the element is now.
  void add(const ChangedElement<E>& change, const ElementPart<E>& part, const CutPhysics<E>& physics) {
    auto [at, is_new] = changed_.try_emplace(change.element);
    Changed& c = at->second;
    if (is_new) {
      c.before = change.before;
      c.added = change.added;
      if (!c.added) {
        c.factorised = physics.stiffness(change.was);
        c.factorised_load = physics.load_of(change.was);
      }
    }
    c.now = change.after;
    c.removed = change.removed;
    if (c.removed) return;
    c.stiffness = physics.stiffness(part);
    c.load = physics.load_of(part);
  }
  void add(const Pin& pin) { pins_.push_back(pin); }

  /// What a further change overwrites, to take it back.
  class Before {
   public:
    Before(const ElementChanges& all, const TopologyChange<E>& change) : pins_(all.pins_.size()) {
      for (const ChangedElement<E>& x : change.elements) {
        const auto at = all.changed_.find(x.element);
        entries_.push_back({x.element, at == all.changed_.end() ? std::nullopt : std::optional(at->second)});
      }
    }

   private:
    friend class ElementChanges;
    struct Entry {
      Index element;
      std::optional<Changed> before;
    };
    std::vector<Entry> entries_;
    std::size_t pins_;
  };
  void restore(const Before& before) noexcept {
    while (pins_.size() > before.pins_) pins_.pop_back();
    for (const auto& entry : before.entries_) {
      const auto at = changed_.find(entry.element);
      if (at == changed_.end()) continue;
      if (entry.before)
        at->second = *entry.before;
      else
        changed_.erase(at);
    }
  }

  /// Places of all changed dofs, sorted.
  template <class Place>
  std::vector<Index> indices(Place&& place) const {
    std::vector<Index> all;
    const auto put = [&](Index p) {
      if (p >= 0) all.push_back(p);
    };
    for (const auto& [e, c] : changed_)
      for (const Connectivity* nodes : {&c.before, &c.now})
        for (const Index p : indices_of(*nodes, place)) put(p);
    for (const Pin& pin : pins_)
      for (int c = 0; c < 3; ++c) put(place(pin.node, c));
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// y -= difference times x, for the columns of x; rows are places.
  template <class Place>
  void subtract_product(const MatrixX& x, MatrixX& y, Place&& place) const {
    for (const auto& [e, c] : changed_) {
      if (!c.added) add_product(c.factorised, c.before, 1.0, x, y, place);
      if (!c.removed) add_product(c.stiffness, c.now, -1.0, x, y, place);
    }
    for (const Pin& pin : pins_)
      for (int k = 0; k < 3; ++k)
        if (const Index p = place(pin.node, k); p >= 0) y.row(p) -= pin.stiffness * x.row(p);
  }

  /// Adds to `load(node, force)` the forces of the changes at displacements `u(node)`. Under this load the factorised
  /// body moves like the remaining one.
  template <class Displacement, class Load>
  void add_forces(Displacement&& u, Load&& load) const {
    for (const auto& entry : changed_) {
      const Changed& c = entry.second;
      const auto scatter = [&](const Connectivity& nodes, const ElementStiffness<E>& k, const Values& own,
                               double sign) {
        Values ue;
        for (int a = 0; a < E::nodes; ++a) ue.template segment<3>(3 * a) = u(nodes[static_cast<std::size_t>(a)]);
        const Values f = sign * (k * ue - own);
        for (int a = 0; a < E::nodes; ++a)
          load(nodes[static_cast<std::size_t>(a)], Vector3(f.template segment<3>(3 * a)));
      };
      if (!c.added) scatter(c.before, c.factorised, c.factorised_load, 1.0);
      if (!c.removed) scatter(c.now, c.stiffness, c.load, -1.0);
    }
    for (const Pin& pin : pins_) load(pin.node, Vector3(-pin.stiffness * (u(pin.node) - pin.rest)));
  }

  template <class Place>
  static Places indices_of(const Connectivity& nodes, Place&& place) {
    Places places;
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = place(nodes[i / 3], static_cast<int>(i % 3));
    return places;
  }

 private:
  template <class Place>
  static void add_product(const ElementStiffness<E>& stiffness, const Connectivity& nodes, double sign,
                          const MatrixX& x, MatrixX& y, Place&& place) {
    const Places at = indices_of(nodes, place);
    for (Index k = 0; k < x.cols(); ++k) {
      Values v;
      for (std::size_t i = 0; i < at.size(); ++i) v[static_cast<Index>(i)] = at[i] < 0 ? 0.0 : x(at[i], k);
      const Values f = sign * (stiffness * v);
      for (std::size_t i = 0; i < at.size(); ++i)
        if (at[i] >= 0) y(at[i], k) += f[static_cast<Index>(i)];
    }
  }

  std::map<Index, Changed> changed_;
  std::vector<Pin> pins_;
};

}}}  // namespace palpate::detail
