// Numbers the sets of tags that the cells of a file have.
#pragma once

#include <palpate/io/file_mesh.hpp>

#include <map>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Numbers found by two others. One type for all uses in this folder, so that it is compiled once.
using PairMap = std::map<std::pair<Index, Index>, std::uint32_t>;

/// Finds entries of FileMesh::tag_sets. Fast when the same single tag is asked for again and again, else
/// O(tags log n).
class TagSets {
 public:
  /// The entry of `mesh.tag_sets` that holds `tags` in this order; added when there is none.
  std::uint32_t find_or_add(FileMesh& mesh, std::span<const int> tags);

  /// The same for one tag; 0 is none.
  std::uint32_t find_or_add(FileMesh& mesh, int tag) {
    if (tag == 0) return 0;
    if (tag != last_tag_) {
      last_set_ = find_or_add(mesh, std::span<const int>(&tag, 1));
      last_tag_ = tag;
    }
    return last_set_;
  }

 private:
  PairMap next_;                          ///< (a beginning of a list of tags, tag) -> the beginning longer by it
  std::vector<std::uint32_t> set_of_{0};  ///< of each beginning; 0 when no cell has just those tags
  int last_tag_ = 0;
  std::uint32_t last_set_ = 0;
};

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/tag_sets.ipp>
#endif
