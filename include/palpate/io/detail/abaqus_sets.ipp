// Definitions of abaqus_sets.hpp.
#pragma once

#include <palpate/io/detail/abaqus_lines.hpp>
#include <palpate/io/detail/abaqus_sets.hpp>

#include <algorithm>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

PALPATE_COLD PALPATE_INLINE void Sets::open(const std::string& name, bool of_assembly, bool is_internal) {
  const auto [known, is_new] =
      by_name_.try_emplace(std::pair(of_assembly, upper(name)), static_cast<Index>(sets_.size()));
  if (is_new) sets_.push_back({name, of_assembly, is_internal, {}});
  definitions_.push_back({static_cast<std::size_t>(known->second), items_.size()});
}

PALPATE_INLINE void Sets::add_ids(Index first, Index last, Index step, Index line) {
  const auto number = [](Index i) { return static_cast<int>(std::min<Index>(i, std::numeric_limits<int>::max())); };
  items_.push_back({number(first), number(last), number(step), number(line)});
}

PALPATE_COLD PALPATE_INLINE void Sets::add_positions(std::size_t first, std::size_t last) {
  items_.push_back({static_cast<int>(first), static_cast<int>(last), 0, 0});
}

PALPATE_COLD PALPATE_INLINE void Sets::add_set(Index set) {
  items_.push_back({static_cast<int>(set), 0, -1, 0});
}

PALPATE_COLD PALPATE_INLINE void Sets::add_nodes_of(Index element_set) {
  items_.push_back({static_cast<int>(element_set), 0, -2, 0});
}

PALPATE_COLD PALPATE_INLINE Index Sets::find(std::string_view name, bool of_assembly) const {
  const std::string key = upper(name);
  auto found = by_name_.end();
  if (of_assembly) found = by_name_.find(std::pair(true, key));
  if (found == by_name_.end()) found = by_name_.find(std::pair(false, key));
  return found == by_name_.end() ? -1 : found->second;
}

PALPATE_INLINE void Sets::add(std::vector<int>& members, const Item& item, const IdTable& ids, const TextReader& in,
                              Index& memberships, const NodesOf& nodes_of) {
  const std::size_t before = members.size();
  if (item.step == -2) {
    nodes_of(item.first, members);
  } else if (item.step < 0) {
    const std::vector<int> other = sets_[static_cast<std::size_t>(item.first)].members;
    check_memberships(in, memberships + static_cast<Index>(other.size()));
    members.insert(members.end(), other.begin(), other.end());
  } else if (item.step == 0) {
    for (int i = item.first; i < item.last; ++i) members.push_back(i);
  } else {
    for (const Ranked& r : ids.from(item.first)) {
      if (r.key > item.last) break;
      if ((r.key - item.first) % item.step == 0)
        members.push_back(static_cast<int>(r.id));
      else
        check_memberships(in, ++memberships);  // so that also the time is proportional to the size of the file
    }
    if (members.size() == before)
      refuse_at(in, item.line, SetupErrorKind::index_out_of_range, {"the id of a ", ids.what, " of this file"},
                {"'", item.first, "'"});
  }
  memberships += static_cast<Index>(members.size() - before);
  check_memberships(in, memberships);
}

PALPATE_INLINE void Sets::resolve(const IdTable& ids, const TextReader& in, Index& memberships,
                                  const NodesOf& nodes_of) {
  for (std::size_t d = 0; d < definitions_.size(); ++d) {
    std::vector<int>& members = sets_[definitions_[d].set].members;
    const std::size_t end = d + 1 < definitions_.size() ? definitions_[d + 1].first_item : items_.size();
    for (std::size_t i = definitions_[d].first_item; i < end; ++i)
      add(members, items_[i], ids, in, memberships, nodes_of);
  }
  for (Set& set : sets_) sort_unique(set.members);
}

PALPATE_COLD PALPATE_INLINE void check_memberships(const TextReader& in, Index memberships) {
  const auto limit = static_cast<Index>(in.size());
  if (memberships > limit)
    in.refuse(SetupErrorKind::count_too_large, {"nodes, elements and faces in sets at most ", limit, " times"},
              {memberships});
}

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
