// Assigns numbers to the sets of tags that occur in a file.
#pragma once

#include <palpate/io/file_mesh.hpp>

#include <map>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Map from a pair of numbers to a number. One type for all uses in this folder, so that it is compiled once.
using PairMap = std::map<std::pair<Index, Index>, std::uint32_t>;

/// Finds entries of FileMesh::tag_sets. O(1) if the same single tag is requested repeatedly, else O(tags log n).
class TagSets {
 public:
  /// The entry of `mesh.tag_sets` with `tags` in this order; added if there is none.
  std::uint32_t find_or_add(FileMesh& mesh, std::span<const int> tags);

  /// The same for one tag; 0 means no tag.
  std::uint32_t find_or_add(FileMesh& mesh, int tag) {
    if (tag == 0) return 0;
    if (tag != last_tag_) {
      last_set_ = find_or_add(mesh, std::span<const int>(&tag, 1));
      last_tag_ = tag;
    }
    return last_set_;
  }

 private:
  PairMap next_;                          ///< (prefix of a tag list, tag) -> the prefix extended by that tag
  std::vector<std::uint32_t> set_of_{0};  ///< tag set of each prefix; 0 if no cell has exactly those tags
  int last_tag_ = 0;
  std::uint32_t last_set_ = 0;
};

inline std::uint32_t TagSets::find_or_add(FileMesh& mesh, std::span<const int> tags) {
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
