// Definitions of node_ids.hpp.
#pragma once

#include <palpate/io/detail/node_ids.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE NodeIds::NodeIds(const std::vector<Index>& tags, const TextReader& in)
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

PALPATE_INLINE NodeId NodeIds::search(Index tag, const TextReader& in) const {
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
