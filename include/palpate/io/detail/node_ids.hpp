// Finds nodes by the ids of the file.
#pragma once

#include <palpate/io/detail/sorting.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// O(1) if the ids are 1 ... n in order, else a binary search.
class NodeIds {
 public:
  /// Refuses an id that occurs twice. O(n log n) unless the ids are 1 ... n.
  NodeIds(const std::vector<Index>& tags, const TextReader& in);

  /// The largest possible id.
  Index last() const noexcept { return in_order_ ? count_ : max_tag; }

  /// The node with that id; refuses an id that is not in the file as index_out_of_range.
  NodeId find(Index tag, const TextReader& in) const {
    if (in_order_ && tag >= 1 && tag <= count_) return static_cast<NodeId>(tag - 1);
    return search(tag, in);
  }

 private:
  NodeId search(Index tag, const TextReader& in) const;

  Index count_;
  bool in_order_ = true;
  std::vector<Ranked> sorted_;  ///< id in the file, node
};

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/node_ids.ipp>
#endif
