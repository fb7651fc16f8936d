// Elements in blocks that lie together, so that what one block reads and writes stays in the first level of the cache.
#pragma once

#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <numeric>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Neighbouring elements of one region.
struct ElementBlock {
  int region = 0;
  std::vector<NodeId> elements;  ///< element ids
};

namespace detail {

/// Halves along the longest side of the box of the centres until a part has at most `most` elements. Cuts are at
/// multiples of `group`.
inline void bisect_elements(std::span<NodeId> elements, const std::vector<Vector3>& centre, Index most, Index group,
                            int region, std::vector<ElementBlock>& blocks) {
  const auto count = static_cast<Index>(elements.size());
  if (count <= most) {
    blocks.push_back({region, {elements.begin(), elements.end()}});
    return;
  }
  Vector3 low = Vector3::Constant(infinity), high = -low;
  for (NodeId e : elements) {
    low = low.cwiseMin(centre[static_cast<std::size_t>(e)]);
    high = high.cwiseMax(centre[static_cast<std::size_t>(e)]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
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

}  // namespace detail

/// Cuts a mesh into blocks of at most `most` elements, all but the last of a region a multiple of `group`. The same
/// mesh gives the same blocks. O(elements log elements).
template <Element E>
std::vector<ElementBlock> element_blocks(const Mesh<E>& mesh, Index most, Index group) {
  std::vector<Vector3> centre;
  std::vector<std::vector<NodeId>> of_region(static_cast<std::size_t>(mesh.region_count()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    centre.push_back(element_nodes<E>(mesh, e).colwise().mean().transpose());
    of_region[static_cast<std::size_t>(mesh.region(e))].push_back(static_cast<NodeId>(e));
  }
  std::vector<ElementBlock> blocks;
  for (std::size_t r = 0; r < of_region.size(); ++r)
    if (!of_region[r].empty()) detail::bisect_elements(of_region[r], centre, most, group, static_cast<int>(r), blocks);
  for (ElementBlock& block : blocks) std::ranges::sort(block.elements);
  return blocks;
}

}}  // namespace palpate
