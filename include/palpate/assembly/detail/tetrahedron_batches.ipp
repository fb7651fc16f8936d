// Definitions of tetrahedron_batches.hpp.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batches.hpp>
#include <palpate/core/detail/box.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void bisect_elements(std::span<NodeId> elements, const std::vector<Vector3>& centre, Index most,
                                    Index group, int region, std::vector<ElementBlock>& blocks) {
  const auto count = static_cast<Index>(elements.size());
  if (count <= most) {
    blocks.push_back({region, {elements.begin(), elements.end()}});
    return;
  }
  Box box;
  for (NodeId e : elements) box.include(centre[static_cast<std::size_t>(e)]);
  const Vector3 size = box.size();
  int axis = 0;
  for (int c = 1; c < 3; ++c)
    if (size[c] > size[axis]) axis = c;
  const Index half = std::max(group, (count / 2 + group / 2) / group * group);
  const auto before = [&](NodeId a, NodeId b) {
    const double xa = centre[static_cast<std::size_t>(a)][axis], xb = centre[static_cast<std::size_t>(b)][axis];
    return xa < xb || (xa == xb && a < b);
  };
  std::nth_element(elements.begin(), elements.begin() + half, elements.end(), before);
  const auto middle = static_cast<std::size_t>(half);
  bisect_elements(elements.subspan(0, middle), centre, most, group, region, blocks);
  bisect_elements(elements.subspan(middle), centre, most, group, region, blocks);
}

}}}  // namespace palpate::detail
