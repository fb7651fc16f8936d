// Named groups of a mesh.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Name of the implicit group of every mesh: its whole boundary.
inline constexpr std::string_view surface_group = "surface";

/// The groups of a mesh, found by name. Adding a name twice merges the two.
class GroupTable {
 public:
  /// nullptr if there is no such group. Linear in the number of groups.
  const Group* find(std::string_view name) const noexcept;

  /// The group of that name, created empty if new.
  Group& get_or_add(std::string_view name, int dimension);

  /// The groups with these names, or all groups if `names` is empty; unknown names are skipped.
  GroupTable chosen(const std::vector<std::string>& names) const;

  /// Sorts and deduplicates the node lists; call once after filling.
  void tidy();

  const std::vector<Group>& all() const noexcept { return groups_; }
  std::vector<Group>& all() noexcept { return groups_; }

 private:
  std::vector<Group> groups_;
};

inline const Group* GroupTable::find(std::string_view name) const noexcept {
  const auto it = std::ranges::find(groups_, name, &Group::name);
  return it == groups_.end() ? nullptr : &*it;
}

inline Group& GroupTable::get_or_add(std::string_view name, int dimension) {
  const auto it = std::ranges::find(groups_, name, &Group::name);
  if (it != groups_.end()) {
    it->dimension = std::max(it->dimension, dimension);
    return *it;
  }
  groups_.push_back({std::string(name), dimension, {}, {}, {}});
  return groups_.back();
}

inline GroupTable GroupTable::chosen(const std::vector<std::string>& names) const {
  if (names.empty()) return *this;
  GroupTable result;
  for (const std::string& name : names)
    if (const Group* g = find(name)) result.get_or_add(name, g->dimension) = *g;
  return result;
}

inline void GroupTable::tidy() {
  for (Group& g : groups_) {
    std::ranges::sort(g.nodes);
    g.nodes.erase(std::unique(g.nodes.begin(), g.nodes.end()), g.nodes.end());
  }
}

}}  // namespace palpate
