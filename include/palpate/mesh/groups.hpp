// Named groups of a mesh.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/groups.ipp>
#endif
