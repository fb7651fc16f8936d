// The three search structures for triangles near a tool named in the thesis (6.2), with a common interface.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/contact/detail/triangle.hpp>

#include <cmath>
#include <numeric>

namespace collision {

using namespace palpate;

struct Surface {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;
  const Vector3& at(int v) const { return positions[static_cast<std::size_t>(v)]; }
  detail::Box box_of(int t) const {
    detail::Box box;
    for (int v : triangles[static_cast<std::size_t>(t)]) box.include(at(v));
    return box;
  }
  double distance2(int t, const Vector3& p) const {
    const Triangle& v = triangles[static_cast<std::size_t>(t)];
    const detail::TrianglePoint on = detail::closest_point(p, at(v[0]), at(v[1]), at(v[2]));
    return (p - on.weights[0] * at(v[0]) - on.weights[1] * at(v[1]) - on.weights[2] * at(v[2])).squaredNorm();
  }
};

/// Bounding volumes: the implementation of the library.
class BoundingVolumes {
 public:
  static constexpr const char* name = "bounding volumes";
  explicit BoundingVolumes(const Surface& s) : bvh_(s.triangles, s.positions) {}
  void moved(const Surface& s) { bvh_.refit(s.triangles, s.positions); }
  template <class Visit>
  void near(const Surface&, const Vector3& p, double radius, Visit&& visit) const {
    bvh_.visit_near(p, radius, visit);
  }

 private:
  detail::Bvh bvh_;
};

/// A balanced binary tree of triangles, split at the median of their centres. A query is enlarged by the largest
/// distance of a triangle's vertex from its centre.
class BinaryTree {
 public:
  static constexpr const char* name = "balanced binary tree";
  explicit BinaryTree(const Surface& s) { build(s); }
  void moved(const Surface& s) { build(s); }
  template <class Visit>
  void near(const Surface&, const Vector3& p, double radius, Visit&& visit) const {
    descend(0, static_cast<int>(items_.size()), p, radius + largest_, visit);
  }

 private:
  struct Item {
    Vector3 centre;
    int triangle = 0, axis = 0;
  };
  void build(const Surface& s) {
    items_.resize(s.triangles.size());
    largest_ = 0.0;
    for (std::size_t t = 0; t < items_.size(); ++t) {
      const Triangle& v = s.triangles[t];
      items_[t] = {(s.at(v[0]) + s.at(v[1]) + s.at(v[2])) / 3.0, static_cast<int>(t), 0};
      for (int k : v) largest_ = std::max(largest_, (s.at(k) - items_[t].centre).norm());
    }
    split(0, static_cast<int>(items_.size()));
  }
  void split(int begin, int end) {
    if (end - begin <= 1) return;
    detail::Box box;
    for (int i = begin; i < end; ++i) box.include(items_[static_cast<std::size_t>(i)].centre);
    int axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [axis](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
    items_[static_cast<std::size_t>(middle)].axis = axis;
    split(begin, middle);
    split(middle + 1, end);
  }
  template <class Visit>
  void descend(int begin, int end, const Vector3& p, double reach, Visit& visit) const {
    if (begin >= end) return;
    const int middle = (begin + end) / 2;
    const Item& item = items_[static_cast<std::size_t>(middle)];
    if ((item.centre - p).squaredNorm() <= reach * reach) visit(item.triangle);
    const double offset = p[item.axis] - item.centre[item.axis];
    if (offset <= reach) descend(begin, middle, p, reach, visit);
    if (offset >= -reach) descend(middle + 1, end, p, reach, visit);
  }

  std::vector<Item> items_;
  double largest_ = 0.0;
};

/// An octree: cells of up to eight triangles. Each triangle is stored in every cell that its box intersects. Cells are
/// split to a maximum depth.
class Octree {
 public:
  static constexpr const char* name = "octree";
  explicit Octree(const Surface& s) : seen_(s.triangles.size(), 0) { build(s); }
  void moved(const Surface& s) { build(s); }
  template <class Visit>
  void near(const Surface&, const Vector3& p, double radius, Visit&& visit) {
    ++query_;
    descend(0, p, radius * radius, visit);
  }

 private:
  struct Cell {
    detail::Box box;
    int child = -1;  // first of eight
    std::vector<int> items;
  };
  void build(const Surface& s) {
    cells_.assign(1, {});
    for (const Vector3& x : s.positions) cells_[0].box.include(x);
    cells_[0].items.resize(s.triangles.size());
    std::iota(cells_[0].items.begin(), cells_[0].items.end(), 0);
    boxes_.clear();
    for (std::size_t t = 0; t < s.triangles.size(); ++t) boxes_.push_back(s.box_of(static_cast<int>(t)));
    split(0, 0);
  }
  void split(std::size_t i, int depth) {
    // Beyond this depth cells are smaller than the triangles in them: the surface of a cube has 6 * 4^depth cells.
    const int most = 1 + static_cast<int>(0.5 * std::log2(static_cast<double>(boxes_.size()) / 6.0));
    if (cells_[i].items.size() <= 8 || depth >= most) return;
    const detail::Box box = cells_[i].box;
    const Vector3 middle = 0.5 * (box.low + box.high);
    const std::vector<int> items = std::move(cells_[i].items);
    cells_[i].items.clear();
    const std::size_t first = cells_.size();
    cells_[i].child = static_cast<int>(first);
    cells_.resize(first + 8);
    for (std::size_t k = 0; k < 8; ++k) {
      Cell& c = cells_[first + k];
      for (int a = 0; a < 3; ++a) {
        const bool high = ((k >> a) & 1u) != 0;
        c.box.low[a] = high ? middle[a] : box.low[a];
        c.box.high[a] = high ? box.high[a] : middle[a];
      }
      for (int t : items) {
        const detail::Box& b = boxes_[static_cast<std::size_t>(t)];
        if ((b.low.array() <= c.box.high.array()).all() && (b.high.array() >= c.box.low.array()).all())
          c.items.push_back(t);
      }
    }
    for (std::size_t k = 0; k < 8; ++k) split(first + k, depth + 1);
  }
  template <class Visit>
  void descend(std::size_t i, const Vector3& p, double limit, Visit& visit) {
    const Cell& c = cells_[i];
    if (!(c.box.squared_distance(p) <= limit)) return;
    for (int t : c.items)
      if (seen_[static_cast<std::size_t>(t)] != query_) {
        seen_[static_cast<std::size_t>(t)] = query_;
        if (boxes_[static_cast<std::size_t>(t)].squared_distance(p) <= limit) visit(t);
      }
    if (c.child < 0) return;
    for (std::size_t k = 0; k < 8; ++k) descend(static_cast<std::size_t>(c.child) + k, p, limit, visit);
  }

  std::vector<Cell> cells_;
  std::vector<detail::Box> boxes_;
  std::vector<unsigned> seen_;
  unsigned query_ = 0;
};

}  // namespace collision
