// Definitions of id_table.hpp.
#pragma once

#include <palpate/io/detail/id_table.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_COLD PALPATE_INLINE void refuse_at(const TextReader& in, Index line, SetupErrorKind kind,
                                           const Pieces& expected, const Pieces& found, const Pieces& hint) {
  io::refuse(kind, {place_text(in.name(), line), ": expected ", joined(expected), ", found ", joined(found)},
             joined(hint));
}

PALPATE_INLINE IdTable::IdTable(std::span<const Index> ids, std::span<const Index> lines, std::string_view of,
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

PALPATE_INLINE std::span<const Ranked> IdTable::from(Index id) const noexcept {
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

PALPATE_INLINE Index IdTable::find(Index id) const noexcept {
  const std::span<const Ranked> rest = from(id);
  return rest.empty() || rest.front().key != id ? -1 : rest.front().id;
}

}}}  // namespace palpate::PALPATE_ABI::io
