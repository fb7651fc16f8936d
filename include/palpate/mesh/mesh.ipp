// Definitions of mesh.hpp.
#pragma once

#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE const Group* GroupTable::find(std::string_view name) const noexcept {
  for (const Group& group : groups_)
    if (group.name == name) return &group;
  return nullptr;
}

PALPATE_INLINE Group& GroupTable::get_or_add(std::string_view name, int dimension) {
  for (Group& group : groups_) {
    if (group.name != name) continue;
    group.dimension = std::max(group.dimension, dimension);
    return group;
  }
  groups_.push_back({std::string(name), dimension, {}, {}, {}});
  return groups_.back();
}

PALPATE_INLINE GroupTable GroupTable::chosen(const std::vector<std::string>& names) const {
  if (names.empty()) return *this;
  GroupTable result;
  for (const std::string& name : names)
    if (const Group* g = find(name)) result.get_or_add(name, g->dimension) = *g;
  return result;
}

PALPATE_INLINE void GroupTable::tidy() {
  for (Group& g : groups_) {
    std::ranges::sort(g.nodes);
    g.nodes.erase(std::unique(g.nodes.begin(), g.nodes.end()), g.nodes.end());
  }
}

}}  // namespace palpate
