// Blocks of neighbouring elements: the data that one block reads and writes stay in the first-level cache.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Neighbouring elements of one region.
struct ElementBlock {
  int region = 0;
  std::vector<NodeId> elements;  ///< element ids
};

namespace detail {

/// Bisects along the longest side of the bounding box of the centres until a part has at most `most` elements. Cuts
/// are at multiples of `group`.
void bisect_elements(std::span<NodeId> elements, const std::vector<Vector3>& centre, Index most, Index group,
                     int region, std::vector<ElementBlock>& blocks);

}  // namespace detail

/// Divides a mesh into blocks of at most `most` elements, all but the last of a region a multiple of `group`.
/// Deterministic for a given mesh. O(elements log elements).
template <Element E>
std::vector<ElementBlock> element_blocks(const Mesh<E>& mesh, Index most, Index group) {
  std::vector<Vector3> centre;
  std::vector<std::vector<NodeId>> of_region(static_cast<std::size_t>(mesh.region_count()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(mesh, e);
    Vector3 sum = Vector3::Zero();
    for (int a = 0; a < E::nodes; ++a)
      for (int c = 0; c < 3; ++c) sum[c] += x.coeff(a, c);
    centre.push_back(sum / double{E::nodes});
    of_region[static_cast<std::size_t>(mesh.region(e))].push_back(static_cast<NodeId>(e));
  }
  std::vector<ElementBlock> blocks;
  for (std::size_t r = 0; r < of_region.size(); ++r)
    if (!of_region[r].empty()) detail::bisect_elements(of_region[r], centre, most, group, static_cast<int>(r), blocks);
  for (ElementBlock& block : blocks) std::ranges::sort(block.elements);
  return blocks;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/element_blocks.ipp>
#endif
