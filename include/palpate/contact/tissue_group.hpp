// Several tissues in one session, touched by the same tools.
#pragma once

#include <palpate/contact/tissue_view.hpp>

#include <concepts>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A tissue of a session, with what differs from ServoOptions::contact.
struct GroupMember {
  TissueView tissue;
  std::optional<double> friction{};  ///< Coulomb's coefficient; default: that of the options
};

/// Tissues of any types: static, moving, cut, stiffening. A HapticServo or HapticSession takes a group where it takes a
/// tissue. Each has its own pose, background worker and friction. A tool between two organs feels both, with one force
/// and one gate; organs touch each other where they are a TouchingTissues. A servo or session refers to the tissues,
/// not to the group, which may be a temporary.
class TissueGroup {
 public:
  TissueGroup() = default;
  template <class... T>
  requires(sizeof...(T) > 0) explicit TissueGroup(T&... tissues) { (add(tissues), ...); }

  /// Adds a tissue, or all tissues of another group. Allocates.
  template <class T>
  TissueGroup& add(T& tissue, std::optional<double> friction = {}) {
    if constexpr (std::same_as<std::remove_cv_t<T>, TissueGroup>)
      for (const GroupMember& m : std::vector(tissue.members_))
        members_.push_back({m.tissue, friction ? friction : m.friction});
    else
      members_.push_back({TissueView(tissue), friction});
    return *this;
  }

  std::span<const GroupMember> members() const noexcept { return members_; }

 private:
  std::vector<GroupMember> members_;
};

}}  // namespace palpate
