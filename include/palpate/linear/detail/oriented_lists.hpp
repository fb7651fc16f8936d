// A part of a graph, sorted along other directions than the axes.
#pragma once

#include <palpate/linear/detail/part_lists.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

using Directions = std::array<Vector3, dissection_axes>;

/// The diagonals of a cube's faces and of the cube, and two more. Separators of a round body are seldom along an axis.
inline const std::array<Directions, 4>& oblique_directions() {
  static const std::array<Directions, 4> all{Directions{Vector3(0, 1, 1), Vector3(1, 0, 1), Vector3(1, 1, 0)},
                                             Directions{Vector3(0, 1, -1), Vector3(-1, 0, 1), Vector3(1, -1, 0)},
                                             Directions{Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1)},
                                             Directions{Vector3(-1, -1, 1), Vector3(2, 1, 0), Vector3(-1, 2, 0)}};
  return all;
}

/// Replaces the sorted lists of a part by lists along three directions until its destruction. Needs coordinates.
class OrientedLists {
 public:
  OrientedLists(PartLists& lists, const Part& part, const Directions& directions) : lists_(lists), part_(part) {
    std::vector<std::pair<double, NodeId>> keys(static_cast<std::size_t>(part.size()));
    for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
      const auto begin = lists.sorted[axis].begin() + part.begin, end = lists.sorted[axis].begin() + part.end;
      axes_[axis].assign(begin, end);
      const Vector3& d = directions[axis];
      std::transform(begin, end, keys.begin(), [&](NodeId v) {
        const Vector3& x = lists.graph->positions[static_cast<std::size_t>(v)];
        return std::pair(d[0] * x[0] + d[1] * x[1] + d[2] * x[2], v);
      });
      std::sort(keys.begin(), keys.end());
      std::transform(keys.begin(), keys.end(), begin, [](const auto& key) { return key.second; });
    }
  }
  OrientedLists(const OrientedLists&) = delete;
  OrientedLists& operator=(const OrientedLists&) = delete;
  ~OrientedLists() {
    for (std::size_t axis = 0; axis < dissection_axes; ++axis)
      std::copy(axes_[axis].begin(), axes_[axis].end(), lists_.sorted[axis].begin() + part_.begin);
  }

 private:
  PartLists& lists_;
  Part part_;
  std::array<std::vector<NodeId>, dissection_axes> axes_;
};

}}}  // namespace palpate::detail
