// A tool that passed through the surface is held on the side from which it pressed.
#pragma once

#include <palpate/contact/contact_problem.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Remembers the last contact of a tool that was right. A tool pressed into linear tissue by more than its radius may
/// pass between contact points: the facets then push it out on the other side. Such a tool returns to the remembered
/// contact, and its target is kept from going deeper than there, along the force of that contact. Sideways it follows
/// the device. This ends when the device is back in front of that plane, or when nothing presses the tool any more.
/// Everything runs in the tick: no throw, no allocation; a tick copies the points that press.
class PushOut {
 public:
  /// `tool` is its number. Allocates for `capacity` contacts.
  PushOut(std::size_t tool, int capacity) : tool_(tool), pressing_(static_cast<std::size_t>(capacity)) {}

  /// After the tool's target was set: limits it while the tool is held. `restarted`: it was placed elsewhere.
  void begin_tick(const ContactProblem& problem, ContactTool& tool, bool restarted) noexcept;
  /// Whether a tool that pressed is on the other side of the surface after a solution: facets push it from behind, the
  /// tissue does not push it back any more and it is inside, or nothing presses it and it is inside.
  bool has_passed(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool,
                  bool converged) const noexcept;
  /// Returns the tool to the remembered contact, and holds it there; false when it was held before.
  bool push_out(ContactProblem& problem, const TissueView& tissue, std::span<ContactTool> tools) noexcept;
  /// Remembers the contact if it is right.
  void end_tick(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool, bool converged) noexcept;
  /// The contact is lost.
  void lose() noexcept {
    forget();
    status_.set(StatusFlag::lost_contact);
  }
  void reset() noexcept {
    forget();
    status_ = {};
  }

  /// Whether the device is no longer behind the place where the tool is held: farther beside it than its diameter.
  bool is_beside(const ContactTool& tool) const noexcept;
  /// lost_contact in a tick in which the tool was held or lost.
  Status status() const noexcept { return status_; }

 private:
  static constexpr double least_share = 0.1;    // of the force, from behind: with more the tool has passed
  static constexpr double longest_path = 0.25;  // of the device from the remembered contact, radii
  static constexpr double step_back = 0.05;     // radii
  static constexpr double least_push = 0.5, least_held = 0.75, certain = 0.8;  // parts of an earlier push
  void forget() noexcept {
    count_ = 0;
    holds_ = false;
  }
  void limit(ContactTool& tool) noexcept;
  /// How far the device is from where it was in the remembered contact, along its force [m].
  double retreat_of(const ContactTool& tool) const noexcept;
  /// Force along that of the remembered contact [N].
  double push_of(const ContactTool& tool) const noexcept;
  bool is_right(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool, bool converged) noexcept;

  std::size_t tool_;
  std::vector<Candidate> pressing_;
  std::size_t count_ = 0;
  ContactTool contact_;   // as it was
  double certain_ = 0.0;  // its force, or a larger one since the tool was known to be outside [N]
  std::uint64_t revision_ = 0, moves_ = 0;
  bool holds_ = false;
  Vector3 side_ = Vector3::Zero();         // unit, the direction in which it is pushed out
  double level_ = 0.0;                     // of the target, along `side_` [m]
  double held_push_ = 0.0;                 // when it was held first [N]
  Vector3 last_target_ = Vector3::Zero();  // while it is held [m]
  Status status_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/push_out.ipp>
#endif
