// The changes of a stiffness by cuts since it was factorised, element by element.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Difference between the current stiffness and the factorised one: minus the changed elements, plus those of them that
/// still exist, on their current nodes, plus springs on unsupported parts. Dofs are looked up by `place(node,
/// component)`, -1 for prescribed ones.
template <Element E>
class ElementChanges {
 public:
  using Values = Eigen::Matrix<double, 3 * E::nodes, 1>;
  using Places = std::array<Index, static_cast<std::size_t>(3 * E::nodes)>;
  using Connectivity = typename Mesh<E>::Connectivity;

  struct Changed {
    Connectivity before{}, now{};
    bool removed = false;
    ElementStiffness<E> stiffness;
    Values load;
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

  void add(const ChangedElement<E>& change, const ElementStiffness<E>& stiffness, const Values& load) {
    auto [at, is_new] = changed_.try_emplace(change.element);
    if (is_new) at->second = {change.before, change.after, change.removed, stiffness, load};
    at->second.now = change.after;
    at->second.removed = change.removed;
  }
  void add(const Pin& pin) { pins_.push_back(pin); }

  /// What a further change overwrites, to take it back.
  class Before {
   public:
    Before(const ElementChanges& all, const TopologyChange<E>& change) : pins_(all.pins_.size()) {
      for (const ChangedElement<E>& x : change.elements) {
        const auto at = all.changed_.find(x.element);
        entries_.push_back(at == all.changed_.end() ? Entry{x.element, false, {}, false}
                                                    : Entry{x.element, true, at->second.now, at->second.removed});
      }
    }

   private:
    friend class ElementChanges;
    struct Entry {
      Index element;
      bool known;
      Connectivity now;
      bool removed;
    };
    std::vector<Entry> entries_;
    std::size_t pins_;
  };
  void restore(const Before& before) noexcept {
    while (pins_.size() > before.pins_) pins_.pop_back();
    for (const auto& entry : before.entries_) {
      const auto at = changed_.find(entry.element);
      if (at == changed_.end()) continue;
      at->second.now = entry.now;
      at->second.removed = entry.removed;
      if (!entry.known) changed_.erase(at);
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
      add_product(c, c.before, 1.0, x, y, place);
      if (!c.removed) add_product(c, c.now, -1.0, x, y, place);
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
      const auto scatter = [&](const Connectivity& nodes, double sign) {
        Values ue;
        for (int a = 0; a < E::nodes; ++a) ue.template segment<3>(3 * a) = u(nodes[static_cast<std::size_t>(a)]);
        const Values f = sign * (c.stiffness * ue - c.load);
        for (int a = 0; a < E::nodes; ++a)
          load(nodes[static_cast<std::size_t>(a)], Vector3(f.template segment<3>(3 * a)));
      };
      scatter(c.before, 1.0);
      if (!c.removed) scatter(c.now, -1.0);
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
  static void add_product(const Changed& c, const Connectivity& nodes, double sign, const MatrixX& x, MatrixX& y,
                          Place&& place) {
    const Places at = indices_of(nodes, place);
    for (Index k = 0; k < x.cols(); ++k) {
      Values v;
      for (std::size_t i = 0; i < at.size(); ++i) v[static_cast<Index>(i)] = at[i] < 0 ? 0.0 : x(at[i], k);
      const Values f = sign * (c.stiffness * v);
      for (std::size_t i = 0; i < at.size(); ++i)
        if (at[i] >= 0) y(at[i], k) += f[static_cast<Index>(i)];
    }
  }

  std::map<Index, Changed> changed_;
  std::vector<Pin> pins_;
};

}}}  // namespace palpate::detail
