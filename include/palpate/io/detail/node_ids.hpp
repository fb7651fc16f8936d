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

inline NodeIds::NodeIds(const std::vector<Index>& tags, const TextReader& in)
    : count_(static_cast<Index>(tags.size())) {
  for (std::size_t i = 0; i < tags.size() && in_order_; ++i) in_order_ = tags[i] == static_cast<Index>(i) + 1;
  if (count_ > max_int) refuse(SetupErrorKind::too_large, {in.name(), ": ", count_, " nodes"});
  if (in_order_) return;
  sorted_.reserve(tags.size());
  bool is_sorted = true;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    is_sorted = is_sorted && (i == 0 || tags[i - 1] < tags[i]);
    sorted_.push_back({tags[i], static_cast<Index>(i)});
  }
  if (is_sorted) return;
  sort_ranked(sorted_);
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i - 1].key == sorted_[i].key)
      in.refuse(SetupErrorKind::bad_file, "every node id once", {"node ", sorted_[i].key, " twice"});
}

inline NodeId NodeIds::search(Index tag, const TextReader& in) const {
  std::size_t low = 0, high = sorted_.size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (sorted_[middle].key < tag)
      low = middle + 1;
    else
      high = middle;
  }
  if (low == sorted_.size() || sorted_[low].key != tag)
    in.refuse(SetupErrorKind::index_out_of_range, "the id of a node of this file", {"'", tag, "'"});
  return static_cast<NodeId>(sorted_[low].id);
}

}}}  // namespace palpate::PALPATE_ABI::io
