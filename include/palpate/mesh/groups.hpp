// Named groups of a mesh.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// Name of the group every mesh has without saying so: its whole boundary.
inline constexpr std::string_view surface_group = "surface";

/// The groups of a mesh, found by name. Adding a name twice merges the two.
class GroupTable {
 public:
  /// nullptr when there is no such group. Linear in the number of groups.
  const Group* find(std::string_view name) const noexcept {
    const auto it = std::ranges::find(groups_, name, &Group::name);
    return it == groups_.end() ? nullptr : &*it;
  }

  /// The group of that name, created empty if new.
  Group& get_or_add(std::string_view name, int dimension) {
    const auto it = std::ranges::find(groups_, name, &Group::name);
    if (it != groups_.end()) {
      it->dimension = std::max(it->dimension, dimension);
      return *it;
    }
    groups_.push_back({std::string(name), dimension, {}, {}, {}});
    return groups_.back();
  }

  /// Sorts and deduplicates the node lists; call once after filling.
  void tidy() {
    for (Group& g : groups_) {
      std::ranges::sort(g.nodes);
      g.nodes.erase(std::unique(g.nodes.begin(), g.nodes.end()), g.nodes.end());
    }
  }

  const std::vector<Group>& all() const noexcept { return groups_; }
  std::vector<Group>& all() noexcept { return groups_; }

 private:
  std::vector<Group> groups_;
};

}}  // namespace palpate
