// Definitions of bvh.hpp.
#pragma once

#include <palpate/contact/detail/bvh.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE Bvh::Bvh(std::span<const Triangle> triangles, std::span<const Vector3> positions)
    : order_(triangles.size()) {
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<int>(i);
  std::vector<Vector3> centre;
  centre.reserve(triangles.size());
  for (const Triangle& t : triangles) centre.push_back(at(positions, t[0]) + at(positions, t[1]) + at(positions, t[2]));
  nodes_.reserve(2 * triangles.size() + 1);
  if (!triangles.empty()) build(0, static_cast<int>(triangles.size()), centre);
  refit(triangles, positions);
}

PALPATE_INLINE void Bvh::refit(std::span<const Triangle> triangles, std::span<const Vector3> positions) noexcept {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    node.box = Box{};
    if (node.count > 0) {
      for (int k = node.first; k < node.first + node.count; ++k)
        for (int v : triangles[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])])
          node.box.include(at(positions, v));
    } else {
      node.box.include(nodes_[i + 1].box);
      node.box.include(nodes_[static_cast<std::size_t>(node.first)].box);
    }
  }
}

PALPATE_INLINE void Bvh::build(int begin, int end, const std::vector<Vector3>& centre) {
  const std::size_t self = nodes_.size();
  nodes_.push_back({Box{}, begin, end - begin});
  if (end - begin <= 4) return;
  Box box;
  for (int k = begin; k < end; ++k) box.include(at(centre, order_[static_cast<std::size_t>(k)]));
  const Vector3 size = box.high - box.low;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (size[k] > size[axis]) axis = k;
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    const double x = at(centre, a)[axis], y = at(centre, b)[axis];
    return x < y || (x == y && a < b);
  });
  nodes_[self].count = 0;
  build(begin, middle, centre);
  nodes_[self].first = static_cast<int>(nodes_.size());
  build(middle, end, centre);
}

}}}  // namespace palpate::detail
