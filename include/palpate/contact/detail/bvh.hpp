// A bounding volume hierarchy of axis-aligned boxes over triangles.
#pragma once

#include <palpate/contact/detail/triangle.hpp>
#include <palpate/core/detail/box.hpp>

#include <array>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Boxes over triangles, split at the median of the longest axis; leaves hold up to four triangles. Queries are O(log n
/// + hits), do not allocate and visit triangles in a fixed order.
class Bvh {
 public:
  Bvh() = default;

  /// Builds over triangles of `positions`. O(n log n), allocates.
  Bvh(std::span<const Triangle> triangles, std::span<const Vector3> positions);

  /// Recomputes all boxes for moved positions. O(n), no allocation.
  void refit(std::span<const Triangle> triangles, std::span<const Vector3> positions) noexcept;

  static constexpr int max_depth = 64;  // median splits halve the count: depth <= log2(2^31), two entries per level
  /// The boxes that a search still has to descend into.
  struct Descent {
    std::array<int, max_depth> stack;
    int top = 0;
  };
  /// Begins a search that is continued by `visit_next_near`.
  Descent begin() const noexcept {
    Descent d;
    if (!nodes_.empty()) d.stack[static_cast<std::size_t>(d.top++)] = 0;
    return d;
  }
  /// Calls visit(triangle) for the triangles of the next leaf whose box comes within `radius` of `centre`. False when
  /// there is none.
  template <class Visit>
  bool visit_next_near(Descent& descent, const Vector3& centre, double radius, Visit&& visit) const noexcept {
    const double limit = radius * radius;
    return visit_next(
        descent, [&](const Box& box) { return box.squared_distance(centre) <= limit; }, visit);
  }

  /// Calls visit(triangle) for every triangle of a leaf whose box comes within `radius` of `centre`.
  template <class Visit>
  void visit_near(const Vector3& centre, double radius, Visit&& visit) const noexcept {
    const double limit = radius * radius;
    descend([&](const Box& box) { return box.squared_distance(centre) <= limit; }, visit);
  }

  /// Calls visit(triangle) for the triangles of leaves whose boxes the path from a point crosses within `margin`. It
  /// returns the fraction of the path beyond which triangles need not be visited any more.
  template <class Visit>
  void visit_along(const Vector3& from, const Vector3& path, double margin, Visit&& visit) const noexcept {
    double until = 1.0;
    descend([&](const Box& box) { return box.is_crossed(from, path, margin, until); },
            [&](int triangle) { until = visit(triangle); });
  }

  /// Finds the triangle for which squared_distance(triangle) is smallest; ties go to the lowest number. -1 when empty.
  template <class SquaredDistance>
  int nearest(const Vector3& point, SquaredDistance&& squared_distance) const noexcept {
    double best = infinity;
    int winner = -1;
    std::array<int, max_depth> stack;
    int top = 0;
    if (!nodes_.empty()) stack[static_cast<std::size_t>(top++)] = 0;
    while (top > 0) {
      const int i = stack[static_cast<std::size_t>(--top)];
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      if (!(node.box.squared_distance(point) <= best)) continue;
      if (node.count > 0) {
        for (int k = node.first; k < node.first + node.count; ++k) {
          const int t = order_[static_cast<std::size_t>(k)];
          const double d = squared_distance(t);
          if (d < best || (d == best && t < winner)) {
            best = d;
            winner = t;
          }
        }
      } else {
        const bool left_first = nodes_[static_cast<std::size_t>(i) + 1].box.squared_distance(point) <=
                                nodes_[static_cast<std::size_t>(node.first)].box.squared_distance(point);
        stack[static_cast<std::size_t>(top++)] = left_first ? node.first : i + 1;
        stack[static_cast<std::size_t>(top++)] = left_first ? i + 1 : node.first;
      }
    }
    return winner;
  }

  const Box& bounds() const noexcept { return nodes_.front().box; }

 private:
  struct Node {
    Box box;
    int first = 0;  // leaf: first of order_; inner: right child (the left one follows directly)
    int count = 0;  // 0 for inner nodes
  };

  /// Calls visit(triangle) for the triangles of leaves below boxes for which reaches(box) holds, left before right.
  template <class Reaches, class Visit>
  void descend(Reaches&& reaches, Visit&& visit) const noexcept {
    for (Descent d = begin(); visit_next(d, reaches, visit);) continue;
  }
  /// The same for one leaf; false when none is left.
  template <class Reaches, class Visit>
  bool visit_next(Descent& descent, Reaches&& reaches, Visit&& visit) const noexcept {
    while (descent.top > 0) {
      const int i = descent.stack[static_cast<std::size_t>(--descent.top)];
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      if (!reaches(node.box)) continue;
      if (node.count > 0) {
        for (int k = node.first; k < node.first + node.count; ++k) visit(order_[static_cast<std::size_t>(k)]);
        return true;
      }
      descent.stack[static_cast<std::size_t>(descent.top++)] = node.first;
      descent.stack[static_cast<std::size_t>(descent.top++)] = i + 1;
    }
    return false;
  }

  static const Vector3& at(std::span<const Vector3> positions, int i) noexcept {
    return positions[static_cast<std::size_t>(i)];
  }

  void build(int begin, int end, const std::vector<Vector3>& centre);

  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/bvh.ipp>
#endif
