// Definitions of bisection.hpp.
#pragma once

#include <palpate/mesh/detail/bisection.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline constexpr std::array<std::array<std::uint8_t, 2>, 6> tetrahedron_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

PALPATE_INLINE double mean_ratio(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept {
  const Vector3 u = b - a, v = c - a, w = d - a;
  const double volume = u.dot(cross(v, w)) / 6.0;
  if (!(volume > 0.0)) return 0.0;
  const double squares = u.squaredNorm() + v.squaredNorm() + w.squaredNorm() + (c - b).squaredNorm() +
                         (d - b).squaredNorm() + (d - c).squaredNorm();
  const double size = std::sqrt(squares);  // without it tiny and huge elements underflow or overflow
  const double relative = 3.0 * volume / size / size / size;
  return 12.0 * std::cbrt(relative * relative);
}

/// 30 bits of the mantissa: lengths that differ by rounding only are equal. Ordered as the numbers.
inline std::uint64_t rounded_order(double square) noexcept {
  constexpr int dropped = 22;
  return (std::bit_cast<std::uint64_t>(square) + (std::uint64_t{1} << (dropped - 1))) >> dropped;
}

PALPATE_INLINE bool Bisection::Rank::operator<(const Rank& other) const noexcept {
  if (length != other.length) return length < other.length;
  for (int i = 0; i < 3; ++i)
    if (middle[i] != other.middle[i]) return middle[i] < other.middle[i];
  return edge < other.edge;
}

PALPATE_INLINE Bisection::Bisection(const Mesh<Tet4>& mesh, Limits limits)
    : limits_(std::move(limits)),
      positions_(mesh.positions),
      elements_(mesh.elements),
      parent_(mesh.elements.size()),
      longest_(mesh.elements.size()),
      star_(mesh.positions.size()),
      first_new_(static_cast<NodeId>(mesh.positions.size())) {
  std::iota(parent_.begin(), parent_.end(), 0);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    for (const NodeId i : elements_[e]) star(i).push_back(static_cast<Element>(e));
    find_longest(static_cast<Element>(e));
  }
}

PALPATE_INLINE Bisection::Rank Bisection::rank(const NodePair& edge) const noexcept {
  return {rounded_order((at(edge.first) - at(edge.second)).squaredNorm()), middle_of(edge), edge};
}

PALPATE_INLINE void Bisection::find_longest(Element e) noexcept {
  const auto& nodes = elements_[static_cast<std::size_t>(e)];
  std::uint8_t best = 0;
  Rank longest;
  for (std::uint8_t k = 0; k < 6; ++k) {
    const Rank other = rank(node_pair(nodes[tetrahedron_edges[k][0]], nodes[tetrahedron_edges[k][1]]));
    if (k > 0 && !(longest < other)) continue;
    longest = other;
    best = k;
  }
  longest_[static_cast<std::size_t>(e)] = best;
}

PALPATE_INLINE NodePair Bisection::longest_of(Element e) const noexcept {
  const auto& nodes = elements_[static_cast<std::size_t>(e)];
  const auto [a, b] = tetrahedron_edges[longest_[static_cast<std::size_t>(e)]];
  return node_pair(nodes[a], nodes[b]);
}

/// Visits every edge once.
template <class Visit>
void Bisection::each_edge(Visit visit) const {
  std::vector<NodeId> seen(positions_.size(), -1);
  for (NodeId a = 0; a < static_cast<NodeId>(positions_.size()); ++a)
    for (const Element e : star(a))
      for (const NodeId b : elements_[static_cast<std::size_t>(e)]) {
        if (b <= a || seen[static_cast<std::size_t>(b)] == a) continue;
        seen[static_cast<std::size_t>(b)] = a;
        visit(NodePair{a, b});
      }
}

PALPATE_INLINE bool Bisection::is_full() const noexcept {
  constexpr std::size_t most_elements = std::numeric_limits<Element>::max() - (1 << 20);
  return static_cast<Index>(positions_.size()) >= limits_.most_nodes || elements_.size() >= most_elements;
}

PALPATE_INLINE void Bisection::find_around(const NodePair& edge) {
  around_.clear();
  const bool first_is_shorter = star(edge.first).size() <= star(edge.second).size();
  const NodeId here = first_is_shorter ? edge.first : edge.second, there = first_is_shorter ? edge.second : edge.first;
  for (const Element e : star(here))
    if (std::ranges::find(elements_[static_cast<std::size_t>(e)], there) !=
        elements_[static_cast<std::size_t>(e)].end())
      around_.push_back(e);
}

PALPATE_INLINE NodePair Bisection::longest_around(const NodePair& edge) const noexcept {
  NodePair longest = edge;
  for (const Element e : around_) {
    const NodePair other = longest_of(e);
    if (other != longest && rank(longest) < rank(other)) longest = other;
  }
  return longest;
}

/// On the boundary, a face at the edge belongs to one element only.
PALPATE_INLINE bool Bisection::is_on_boundary(const NodePair& edge) {
  others_.clear();
  for (const Element e : around_)
    for (const NodeId i : elements_[static_cast<std::size_t>(e)])
      if (i != edge.first && i != edge.second) others_.push_back(i);
  return std::ranges::any_of(others_, [&](NodeId i) { return std::ranges::count(others_, i) == 1; });
}

/// Least quality of the halves of all elements around the edge.
PALPATE_INLINE double Bisection::quality_at(const NodePair& edge, const Vector3& middle) const noexcept {
  double least = 1.0;
  for (const Element e : around_)
    for (const NodeId replaced : {edge.first, edge.second}) {
      std::array<const Vector3*, 4> x{};
      for (std::size_t a = 0; a < 4; ++a) {
        const NodeId i = elements_[static_cast<std::size_t>(e)][a];
        x[a] = i == replaced ? &middle : &at(i);
      }
      least = std::min(least, mean_ratio(*x[0], *x[1], *x[2], *x[3]));
    }
  return least;
}

/// Divides an edge whose elements are in `around_`, unless an element would become too bad.
PALPATE_INLINE bool Bisection::divide(const NodePair& edge) {
  Vector3 place = middle_of(edge);
  const auto middle = static_cast<NodeId>(positions_.size());
  if (!(quality_at(edge, place) >= limits_.least_quality)) return false;
  if (limits_.place_on_boundary && is_on_boundary(edge))
    place = limits_.place_on_boundary(middle, place, (at(edge.first) - at(edge.second)).norm(),
                                      [&](const Vector3& x) { return quality_at(edge, x); });
  positions_.push_back(place);
  star_.emplace_back();
  divided_.push_back(edge);
  for (const Element e : around_) {
    const auto part = static_cast<Element>(elements_.size());
    auto other = elements_[static_cast<std::size_t>(e)];
    for (const NodeId i : other)
      if (i == edge.second)
        *std::ranges::find(star(i), e) = part;
      else if (i != edge.first)
        star(i).push_back(part);
    std::ranges::replace(other, edge.first, middle);
    std::ranges::replace(elements_[static_cast<std::size_t>(e)], edge.second, middle);
    elements_.push_back(other);
    parent_.push_back(parent_[static_cast<std::size_t>(e)]);
    longest_.push_back(0);
    for (const Element half : {e, part}) {
      star(middle).push_back(half);
      find_longest(half);
    }
  }
  return true;
}

PALPATE_INLINE void Bisection::wish(const NodePair& edge, const Wanted& wanted) {
  const double length = (at(edge.first) - at(edge.second)).norm(), ratio = length / wanted(middle_of(edge), length);
  if (ratio > 1.0 + 1e-9) wishes_.push({ratio, rank(edge)});
}

/// Divides an edge after all longer ones around it. Where the longest cannot be divided, the one before it on the path
/// is. False if the edge is left: no edge of the path can be divided, or the mesh is full.
PALPATE_INLINE bool Bisection::fulfil(const NodePair& edge, const Wanted& wanted) {
  std::vector<NodePair> path{edge};
  bool is_blocked = false;
  while (!path.empty() && !is_full()) {
    const NodePair last = path.back();
    find_around(last);
    if (around_.empty()) {  // divided on the way
      path.pop_back();
      continue;
    }
    if (const NodePair longer = is_blocked ? last : longest_around(last); longer != last) {
      path.push_back(longer);
      continue;
    }
    path.pop_back();
    is_blocked = !divide(last);
    if (is_blocked) continue;
    const auto middle = static_cast<NodeId>(positions_.size() - 1);
    std::vector<NodeId> neighbours;
    for (const Element e : star(middle))
      for (const NodeId i : elements_[static_cast<std::size_t>(e)])
        if (i != middle) neighbours.push_back(i);
    std::ranges::sort(neighbours);
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    for (const NodeId i : neighbours) wish(node_pair(i, middle), wanted);
  }
  return path.empty() && !is_blocked;
}

PALPATE_INLINE Bisection::TooLong Bisection::refine(const Wanted& wanted) {
  each_edge([&](const NodePair& edge) { wish(edge, wanted); });
  std::vector<Wish> blocked;
  std::size_t divided_before = 0;
  while (!is_full()) {
    if (wishes_.empty()) {  // what is blocked may be possible after its surroundings have changed
      if (blocked.empty() || divided_before == divided_.size()) break;
      divided_before = divided_.size();
      for (const Wish& w : blocked) wishes_.push(w);
      blocked.clear();
    }
    const Wish next = wishes_.top();
    wishes_.pop();
    if (!fulfil(next.rank.edge, wanted)) blocked.push_back(next);
  }
  TooLong left;
  const auto count = [&](const Wish& w) {
    find_around(w.rank.edge);
    if (around_.empty()) return;
    ++left.count;
    left.worst = std::max(left.worst, w.ratio);
  };
  for (; !wishes_.empty(); wishes_.pop()) count(wishes_.top());
  std::ranges::for_each(blocked, count);
  return left;
}

PALPATE_INLINE bool Bisection::move(NodeId node, const Vector3& to) {
  Vector3& x = positions_[static_cast<std::size_t>(node)];
  const Vector3 before = x;
  x = to;
  for (const Element e : star(node)) {
    const auto& n = elements_[static_cast<std::size_t>(e)];
    if (mean_ratio(at(n[0]), at(n[1]), at(n[2]), at(n[3])) >= limits_.least_quality) continue;
    x = before;
    return false;
  }
  return true;
}

PALPATE_INLINE Bisection::Elements Bisection::sorted_elements() const {
  Elements sorted;
  sorted.first.assign(parent_.empty() ? 1 : static_cast<std::size_t>(1 + *std::ranges::max_element(parent_)) + 1, 0);
  for (const Element p : parent_) ++sorted.first[static_cast<std::size_t>(p) + 1];
  std::partial_sum(sorted.first.begin(), sorted.first.end(), sorted.first.begin());
  sorted.elements.resize(elements_.size());
  std::vector<Index> next = sorted.first;
  for (std::size_t e = 0; e < elements_.size(); ++e)
    sorted.elements[static_cast<std::size_t>(next[static_cast<std::size_t>(parent_[e])]++)] = elements_[e];
  return sorted;
}

}}}  // namespace palpate::detail
