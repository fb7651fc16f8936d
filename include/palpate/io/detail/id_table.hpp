// Finds nodes and elements by the ids of the file, by sorting, and reports lines that were read before.
#pragma once

#include <palpate/io/detail/text_reader.hpp>
#include <palpate/io/file_mesh.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// An id and its sort key.
struct Ranked {
  Index key, id;
};

/// Sorts by key, then by id.
inline void sort_ranked(std::vector<Ranked>& all) {
  std::sort(all.begin(), all.end(),
            [](const Ranked& a, const Ranked& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
}

/// Sorts numbers and removes duplicates.
inline void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Refuses what was found in an earlier line of the file.
[[noreturn]] PALPATE_COLD inline void refuse_at(const TextReader& in, Index line, SetupErrorKind kind,
                                                const Pieces& expected, const Pieces& found, const Pieces& hint = {}) {
  io::refuse(kind, {location_text(in.name(), line), ": expected ", joined(expected), ", found ", joined(found)},
             joined(hint));
}

/// Positions of nodes or elements by their ids, which may be any.
class IdTable {
 public:
  /// Refuses an id that occurs twice; `what` is "node" or "element". O(n log n) unless the ids ascend.
  IdTable(std::span<const Index> ids, std::span<const Index> lines, std::string_view what, const TextReader& in);

  /// The position of an id, -1 if there is none.
  Index find(Index id) const noexcept {
    const std::span<const Ranked> rest = from(id);
    return rest.empty() || rest.front().key != id ? -1 : rest.front().id;
  }

  /// Ids and positions, ascending, from the first id that is not less than `id`.
  std::span<const Ranked> from(Index id) const noexcept;

  std::string_view what;

 private:
  std::vector<Ranked> sorted_;
};

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

inline IdTable::IdTable(std::span<const Index> ids, std::span<const Index> lines, std::string_view of,
                        const TextReader& in)
    : what(of) {
  sorted_.reserve(ids.size());
  bool is_sorted = true;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    is_sorted = is_sorted && (i == 0 || ids[i - 1] < ids[i]);
    sorted_.push_back({ids[i], static_cast<Index>(i)});
  }
  if (is_sorted) return;
  sort_ranked(sorted_);
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i - 1].key == sorted_[i].key)
      refuse_at(in, lines[static_cast<std::size_t>(sorted_[i].id)], SetupErrorKind::bad_file,
                {"every ", what, " id once"}, {what, " ", sorted_[i].key, " again"});
}

inline std::span<const Ranked> IdTable::from(Index id) const noexcept {
  std::size_t low = 0, high = sorted_.size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (sorted_[middle].key < id)
      low = middle + 1;
    else
      high = middle;
  }
  return std::span<const Ranked>(sorted_).subspan(low);
}

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
