// Definitions of tag_sets.hpp.
#pragma once

#include <palpate/io/detail/tag_sets.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE std::uint32_t TagSets::find_or_add(FileMesh& mesh, std::span<const int> tags) {
  std::uint32_t at = 0;
  for (const int tag : tags) {
    const auto [next, is_new] =
        next_.try_emplace(std::pair<Index, Index>(at, tag), static_cast<std::uint32_t>(set_of_.size()));
    if (is_new) set_of_.push_back(0);
    at = next->second;
  }
  if (at != 0 && set_of_[at] == 0) {
    set_of_[at] = static_cast<std::uint32_t>(mesh.tag_sets.size());
    mesh.tag_sets.push_back(std::vector<int>(tags.begin(), tags.end()));
  }
  return set_of_[at];
}

}}}  // namespace palpate::PALPATE_ABI::io
