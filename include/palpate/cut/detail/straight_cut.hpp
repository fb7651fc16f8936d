// Makes faces of a mesh lie where a blade cuts it.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/allowed_motion.hpp>
#include <palpate/cut/detail/sheet_distance.hpp>
#include <palpate/cut/detail/swept_faces.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/quality.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Moves nodes onto the sheet of a blade and divides edges there, so that no element is on both sides of it where the
/// blade has passed. Every edge beside the sheet that crosses it gets an end there, the nearer one where it can; nodes
/// on the sheet and beside poor elements are moved, those along it, until the elements are good enough. An element
/// with all nodes on the sheet has no volume left and is removed. An edge whose ends cannot be moved is divided. Where
/// that would leave an element worse than allowed, a cut follows the faces nearest to the sheet.
///
/// Nodes as in the snapping of Molino, Bao and Fedkiw (2004) and Labelle and Shewchuk (2007).
template <Element E, class Position, class Fixed>
class StraightCut {
 public:
  /// `least` is the least quality of an element after the cut. `position(node)` is where the blade finds a node of the
  /// given topology, `is_fixed(node)` whether it must not be moved. All must outlive it. The sheet has an area.
  /// `last` are the nodes on the sheet of the sweep that this one continues.
  StraightCut(const CutTopology<E>& topology, const BladeSweep& sweep, double least, const Position& position,
              const Fixed& is_fixed, const std::set<NodeId>& last)
      : topology_(topology),
        sweep_(sweep),
        distance_(sweep),
        position_(position),
        is_fixed_(is_fixed),
        wanted_(least),
        near_(elements_near(topology, sweep, position)) {
    constexpr double beside = 0.25;  // of the size of an element
    for (const Index e : near_)
      for (const NodeId node : nodes_of(e))
        if (is_of(last, node) && std::abs(distance_(at(node))) <= beside * size(e)) kept_.insert(node);
  }

  /// The nodes to move and the flat elements to remove. O(elements near the sheet).
  ReshapingOrder moves() {
    constexpr int passes = 8;
    for (int pass = 0; pass < passes; ++pass) {
      find_crossed();
      accepted_ = std::min(wanted_, poor);
      const bool any = move_ends();
      accepted_ = wanted_;
      improve_elements();
      if (!any) break;
    }
    take_back();
    return order();
  }
  /// The edges to divide after the moves; call it again after that, until there are none.
  ReshapingOrder divisions() {
    near_ = elements_near(topology_, sweep_, [&](NodeId node) { return at(node); });
    find_crossed();
    ReshapingOrder order;
    std::set<Index> taken;
    for (const Edge& edge : crossing_edges()) divide(edge, taken, order);
    return order;
  }
  /// Where the blade finds a node after moves and divisions.
  Vector3 at(NodeId node) const {
    const auto found = placed_.find(node);
    return found != placed_.end() ? found->second : position_(node);
  }
  /// Whether two elements are on one side of the sheet, beside a node of its last part: a body that has moved a little
  /// does not part them.
  bool are_together(Index e, Index other) const {
    const auto is_kept = [&](NodeId node) { return kept_.contains(node); };
    return (std::ranges::any_of(nodes_of(e), is_kept) || std::ranges::any_of(nodes_of(other), is_kept)) &&
           is_in_front(e) == is_in_front(other);
  }
  /// The faces to open after moves and divisions: between elements on different sides, in the area that the blade has
  /// swept.
  std::vector<ElementFace> faces(const SweptArea& area) const {
    std::vector<ElementFace> open;
    for (const Index e : near_) {
      if (topology_.is_removed(e)) continue;
      for (std::size_t f = 0; f < E::faces.size(); ++f) {
        const Index other = topology_.neighbour(e, f);
        if (other <= e || is_in_front(e) == is_in_front(other)) continue;
        const auto face = topology_.face_nodes({e, static_cast<int>(f)});
        Vector3 sum = Vector3::Zero();
        for (const NodeId node : face) sum += at(node);
        if (area.contains(sum / static_cast<double>(face.size()))) open.push_back({e, static_cast<int>(f)});
      }
    }
    return open;
  }
  /// The nodes on the sheet, those of its last part among them.
  std::set<NodeId> on_sheet_nodes() const {
    std::set<NodeId> found;
    for (const Index e : near_)
      for (const NodeId node : nodes_of(e))
        if (std::abs(distance(node)) <= on_sheet * size(e)) found.insert(node);
    return found;
  }
  const std::map<NodeId, Vector3>& placed() const noexcept { return placed_; }

 private:
  std::vector<Index> changed_elements() const {
    std::vector<Index> changed;
    for (const auto& [node, x] : placed_)
      changed.insert(changed.end(), topology_.elements_at(node).begin(), topology_.elements_at(node).end());
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
  }
  struct Edge {
    long long effort;  // distance of the nearer end in millionths of the length
    NodeId nearer, farther;
  };
  static constexpr double on_sheet = 0.005;  // distance of a node that counts as on the sheet, in sizes of its element
  static constexpr double at_rest = 0.8;     // share of the quality in the displaced body that an element has at rest
  static constexpr double poor = 0.05;       // quality accepted before elements are improved

  const auto& nodes_of(Index e) const { return topology_.mesh().elements[static_cast<std::size_t>(e)]; }
  template <class Place>
  double quality_of(Index e, Place&& place) const {
    ElementNodes<E> x;
    for (int a = 0; a < E::nodes; ++a) x.row(a) = place(nodes_of(e)[static_cast<std::size_t>(a)]).transpose();
    return element_shape<E>(x).quality;
  }
  double quality(Index e) const {
    return quality_of(e, [&](NodeId node) { return at(node); });
  }
  double size(Index e) const {
    double longest = 0.0;
    for (const NodeId a : nodes_of(e))
      for (const NodeId b : nodes_of(e)) longest = std::max(longest, (at(a) - at(b)).norm());
    return longest;
  }
  bool is_flat(Index e) const {
    const double tolerance = on_sheet * size(e);
    return std::ranges::all_of(nodes_of(e), [&](NodeId node) { return std::abs(distance_(at(node))) <= tolerance; });
  }

  /// Elements on both sides of the sheet through which the blade passes.
  void find_crossed() {
    for (const Index e : near_) {
      if (flat_.contains(e) || topology_.is_removed(e)) continue;
      const auto& nodes = nodes_of(e);
      bool crosses_plane = false, is_swept = false;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t j = i + 1; j < nodes.size(); ++j) {
          crosses_plane = crosses_plane || crossing(nodes[i], nodes[j]);
          is_swept = is_swept || sweep_.crosses(at(nodes[i]), at(nodes[j]));
        }
      if (crosses_plane && (is_swept || is_met(e, sweep_.a0, sweep_.b0) || is_met(e, sweep_.a1, sweep_.b1) ||
                            is_met(e, sweep_.a0, sweep_.a1) || is_met(e, sweep_.b0, sweep_.b1)))
        crossed_.insert(e);
    }
  }
  /// Whether the segment from p to q passes through an element.
  bool is_met(Index e, const Vector3& p, const Vector3& q) const {
    double first = 0.0, last = 1.0;
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      const auto face = topology_.face_nodes({e, static_cast<int>(f)});
      const Vector3 a = at(face[0]), outward = cross(at(face[1]) - a, at(face[2]) - a);
      const double from = outward.dot(p - a), to = outward.dot(q - a);
      if (from > 0.0 && to > 0.0) return false;
      if (from > 0.0) first = std::max(first, from / (from - to));
      if (to > 0.0) last = std::min(last, from / (from - to));
    }
    return first < last;
  }
  /// Whether a set has a node or one that it was copied from.
  bool is_of(const std::set<NodeId>& nodes, NodeId node) const {
    while (!nodes.contains(node)) {
      const NodeId from = topology_.copied_from(node);
      if (from == node) return false;
      node = from;
    }
    return true;
  }
  /// Signed, from the sheet; 0 for nodes of its last part that are still beside it.
  double distance(NodeId node) const { return kept_.contains(node) ? 0.0 : distance_(at(node)); }
  /// An element that does not cross the sheet is on the side of its nodes that are not there.
  bool is_in_front(Index e) const {
    double sum = 0.0, centre = 0.0;
    const double tolerance = on_sheet * size(e);
    for (const NodeId node : nodes_of(e)) {
      const double d = distance(node);
      sum += std::abs(d) > tolerance ? d : 0.0;
      centre += distance_(at(node));
    }
    return (sum != 0.0 ? sum : centre) > 0.0;
  }
  std::optional<Edge> crossing(NodeId i, NodeId j) const {
    const double a = distance(i), b = distance(j), length = (at(i) - at(j)).norm();
    if (!(std::min(a, b) < -on_sheet * length && std::max(a, b) > on_sheet * length)) return {};
    constexpr double steps = 1e6;  // rounding does not decide between equal efforts
    const auto effort = [&](double d) { return std::llround(steps * std::abs(d) / length); };
    const bool is_first = effort(a) <= effort(b);
    return Edge{std::min(effort(a), effort(b)), is_first ? i : j, is_first ? j : i};
  }
  /// The easiest first.
  std::vector<Edge> crossing_edges() const {
    std::vector<Edge> edges;
    for (const Index e : crossed_) {
      if (flat_.contains(e) || topology_.is_removed(e)) continue;
      const auto& nodes = nodes_of(e);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t j = i + 1; j < nodes.size(); ++j)
          if (const auto edge = crossing(nodes[i], nodes[j])) edges.push_back(*edge);
    }
    const auto key = [](const Edge& e) { return std::tuple(e.effort, e.nearer, e.farther); };
    std::ranges::sort(edges, {}, key);
    const auto repeated = std::ranges::unique(edges, {}, key);
    edges.erase(repeated.begin(), repeated.end());
    return edges;
  }

  bool move_ends() {
    bool any = false;
    for (const Edge& edge : crossing_edges())
      if (crossing(edge.nearer, edge.farther) && (move_onto_sheet(edge.nearer) || move_onto_sheet(edge.farther)))
        any = true;
    return any;
  }
  bool move_onto_sheet(NodeId node) {
    constexpr double least_slope = 0.3;  // of a surface along which a node is moved
    const Vector3 x = at(node), normal = distance_.normal_at(x);
    if (is_fixed(node)) return false;
    const Vector3 direction = allowed(node).project(normal);
    const double slope = direction.dot(normal);
    return slope > least_slope && place(node, x - distance_(x) / slope * direction);
  }
  /// Also on the walls of earlier cuts.
  bool is_fixed(NodeId node) const { return is_fixed_(node) || topology_.is_on_wall(node); }
  /// As before the cut: elements that become flat have no normals.
  AllowedMotion allowed(NodeId node) const { return allowed_motion(topology_, node, position_); }
  /// False, and nothing changes, where an element that does not become flat would become worse than accepted.
  bool place(NodeId node, const Vector3& to) {
    const auto found = placed_.find(node);
    const std::optional<Vector3> before = found != placed_.end() ? std::optional(found->second) : std::nullopt;
    placed_[node] = to;
    std::vector<Index> flat;
    for (const Index e : topology_.elements_at(node)) {
      if (flat_.contains(e) || (topology_.state(e) == ElementState::supported && quality(e) >= accepted_)) continue;
      if (topology_.state(e) != ElementState::supported || !is_flat(e)) {
        put_back(node, before);
        return false;
      }
      flat.push_back(e);
    }
    flat_.insert(flat.begin(), flat.end());
    return true;
  }
  void put_back(NodeId node, const std::optional<Vector3>& to) {
    if (to)
      placed_[node] = *to;
    else
      placed_.erase(node);
  }

  void improve_elements() {
    constexpr int sweeps = 6;
    const double good = 1.5 * wanted_;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      std::set<NodeId> beside;
      for (const Index e : changed_elements())
        if (!flat_.contains(e) && quality(e) < good) beside.insert(nodes_of(e).begin(), nodes_of(e).end());
      bool any = false;
      for (const NodeId node : beside) any = improve(node) || any;
      if (!any) return;
    }
  }
  double worst_around(NodeId node) const {
    double worst = infinity;
    for (const Index e : topology_.elements_at(node))
      if (!flat_.contains(e)) worst = std::min(worst, quality(e));
    return worst;
  }
  /// Moves a node a little, along the sheet where it is there, so that the worst element around it becomes better.
  bool improve(NodeId node) {
    constexpr double longest_step = 0.2, shortest_step = 0.02;  // sizes of the smallest element
    constexpr double least_gain = 1.02;
    const auto& around = topology_.elements_at(node);
    const auto is_supported = [&](Index e) { return topology_.state(e) == ElementState::supported; };
    if (is_fixed(node) || !std::ranges::all_of(around, is_supported)) return false;
    double smallest = infinity;
    for (const Index e : around) smallest = std::min(smallest, size(e));
    const auto found = placed_.find(node);
    const std::optional<Vector3> before = found != placed_.end() ? std::optional(found->second) : std::nullopt;
    Vector3 best_place = at(node);
    AllowedMotion motion = allowed(node);
    if (std::abs(distance(node)) <= on_sheet * smallest) motion.add_plane(distance_.normal_at(best_place));
    double best = worst_around(node);
    bool any = false;
    for (double step = longest_step * smallest; step > shortest_step * smallest; step *= 0.5)
      for (int k = 0; k < 6; ++k) {
        Vector3 direction = Vector3::Zero();
        direction[k / 2] = k % 2 == 0 ? 1.0 : -1.0;
        placed_[node] = best_place + step * motion.project(direction);
        const double worst = worst_around(node);
        if (!(worst > least_gain * best)) continue;
        best = worst;
        best_place = placed_[node];
        any = true;
      }
    put_back(node, any ? std::optional(best_place) : before);
    return any;
  }
  /// Takes back the moves beside elements that are still worse than allowed.
  void take_back() {
    for (bool any = true; std::exchange(any, false);)
      for (const Index e : changed_elements()) {
        if (flat_.contains(e) && is_flat(e)) continue;
        flat_.erase(e);
        if (quality(e) >= wanted_) continue;
        for (const NodeId node : nodes_of(e)) any = placed_.erase(node) > 0 || any;
      }
    std::erase_if(flat_, [&](Index e) { return !is_flat(e); });
  }

  /// Divides an edge unless an element around it would become too bad, or is divided already.
  void divide(const Edge& edge, std::set<Index>& taken, ReshapingOrder& order) {
    NodeId from = edge.nearer, to = edge.farther;
    if (!topology_.is_divisible(from, to)) return;
    const std::vector<Index> around = topology_.elements_around(from, to);
    if (std::ranges::any_of(around, [&](Index e) { return taken.contains(e); })) return;
    const double part = distance(from) / (distance(from) - distance(to));
    const Vector3 x = at(from) + part * (at(to) - at(from));
    const Mesh<E>& mesh = topology_.mesh();
    const Vector3 rest = mesh.position(from) + part * (mesh.position(to) - mesh.position(from));
    const auto is_good = [&](Index e, NodeId end) {
      return quality_of(e, [&](NodeId node) { return node == end ? x : at(node); }) >= wanted_ &&
             quality_of(e, [&](NodeId node) { return node == end ? rest : mesh.position(node); }) >= at_rest * wanted_;
    };
    if (!std::ranges::all_of(around, [&](Index e) { return is_good(e, from) && is_good(e, to); })) return;
    taken.insert(around.begin(), around.end());
    if (topology_.constrained()[static_cast<std::size_t>(from)] != 0) std::swap(from, to);  // nodes inherit from `from`
    placed_[static_cast<NodeId>(mesh.node_count() + static_cast<Index>(order.divide.size()))] = x;
    order.divide.push_back({from, to, rest});
  }

  /// In the body at rest, where elements that would become too bad take back moves, too.
  ReshapingOrder order() {
    std::map<NodeId, Vector3> rest;
    const auto place = [&](NodeId node) -> Vector3 {
      const auto found = rest.find(node);
      return found != rest.end() ? found->second : topology_.mesh().position(node);
    };
    for (bool any = true; std::exchange(any, false);) {
      rest.clear();
      for (const auto& [node, x] : placed_) rest[node] = rest_position(node, x);
      for (const Index e : changed_elements()) {
        if (flat_.contains(e) || quality_of(e, place) >= at_rest * wanted_) continue;
        for (const NodeId node : nodes_of(e)) any = placed_.erase(node) > 0 || any;
      }
      if (any) take_back();
    }
    ReshapingOrder made;
    for (const auto& [node, x] : rest) made.move.push_back({node, x});
    made.remove.assign(flat_.begin(), flat_.end());
    return made;
  }
  /// By the mean deformation gradient of the elements around a node.
  Vector3 rest_position(NodeId node, const Vector3& to) const {
    Matrix3 gradient = Matrix3::Zero();
    for (const Index e : topology_.elements_at(node)) {
      const auto& nodes = nodes_of(e);
      Matrix3 rest, now;
      for (int k = 0; k < 3; ++k) {
        const NodeId other = nodes[static_cast<std::size_t>(k + 1)];
        rest.col(k) = topology_.mesh().position(other) - topology_.mesh().position(nodes[0]);
        now.col(k) = position_(other) - position_(nodes[0]);
      }
      gradient += now * rest.inverse();
    }
    gradient /= static_cast<double>(topology_.elements_at(node).size());
    return topology_.mesh().position(node) + gradient.inverse() * (to - position_(node));
  }

  const CutTopology<E>& topology_;
  BladeSweep sweep_;
  SheetDistance distance_;
  const Position& position_;
  const Fixed& is_fixed_;
  double wanted_, accepted_ = 0.0;  // qualities
  std::vector<Index> near_;
  std::set<Index> crossed_, flat_;
  std::set<NodeId> kept_;             // on the last part of the sheet, which the body has moved since
  std::map<NodeId, Vector3> placed_;  // where the blade finds nodes that were moved or made
};

}}}  // namespace palpate::detail
