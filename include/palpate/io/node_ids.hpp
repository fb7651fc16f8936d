// Finds nodes by the ids of the file.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Free when the ids are 1 ... n in order, else a binary search.
class NodeIds {
 public:
  /// Refuses an id that occurs twice. O(n log n) unless the ids are 1 ... n.
  NodeIds(const std::vector<Index>& tags, const TextReader& in) : count_(static_cast<Index>(tags.size())) {
    for (std::size_t i = 0; i < tags.size() && in_order_; ++i) in_order_ = tags[i] == static_cast<Index>(i) + 1;
    if (count_ > max_int) raise(SetupErrorKind::too_large, in.name() + ": " + std::to_string(count_) + " nodes");
    if (in_order_) return;
    sorted_.reserve(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], static_cast<NodeId>(i));
    std::ranges::sort(sorted_);
    const auto twice = std::ranges::adjacent_find(sorted_, {}, &std::pair<Index, NodeId>::first);
    if (twice != sorted_.end())
      in.refuse(SetupErrorKind::bad_file, "every node id once", "node " + std::to_string(twice->first) + " twice");
  }

  /// The largest id that can be there.
  Index last() const noexcept { return in_order_ ? count_ : max_tag; }

  /// The node of that id; refuses one that the file does not hold as index_out_of_range.
  NodeId find(Index tag, const TextReader& in) const {
    if (in_order_ && tag >= 1 && tag <= count_) return static_cast<NodeId>(tag - 1);
    const auto it = std::ranges::lower_bound(sorted_, tag, {}, &std::pair<Index, NodeId>::first);
    if (it == sorted_.end() || it->first != tag)
      in.refuse(SetupErrorKind::index_out_of_range, "the id of a node of this file", '\'' + std::to_string(tag) + '\'');
    return it->second;
  }

 private:
  Index count_;
  bool in_order_ = true;
  std::vector<std::pair<Index, NodeId>> sorted_;
};

}}}  // namespace palpate::io
