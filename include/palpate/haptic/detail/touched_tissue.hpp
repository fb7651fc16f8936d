// One tissue of a servo, with its contact problem and the tools as this tissue has them.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/haptic/detail/ramped_value.hpp>
#include <palpate/haptic/detail/tool_recovery.hpp>
#include <palpate/haptic/detail/touch.hpp>
#include <palpate/haptic/servo_options.hpp>

#include <memory>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One tissue of a servo: what `HapticServo::tick` does with it, up to the forces of its contacts. Everything but the
/// constructor runs in the tick: no throw, no allocation.
class TouchedTissue {
 public:
  /// Throws as HapticServo does for a tissue.
  TouchedTissue(const GroupMember& member, const ToolList& tools, const ServoOptions& options);

  /// Takes what moved or was cut since the last tick.
  void take_news() noexcept {
    solved_ = {};
    news_ = view_.begin_tick(*problem_);
  }
  /// Follows the parameters that were set since.
  void follow_parameters(int ramp_ticks) noexcept;
  void receive(std::size_t tool, const ToolState& state) noexcept;
  /// Notes when a tissue that moves by itself was last updated.
  void note_updates() noexcept;
  /// Solves the contact problem for the present targets. `begin`, `iterate` and `end` are the parts of `solve`.
  void solve() noexcept { solved_ |= problem_->solve(view_, tools_); }
  void begin() noexcept { solved_ |= problem_->begin(view_, tools_); }
  void iterate() noexcept { solved_ |= problem_->iterate(view_, tools_); }
  /// The same with fewer linearisations, after a small change of the targets.
  void iterate(int linearisations) noexcept { solved_ |= problem_->iterate(view_, tools_, linearisations); }
  void end() noexcept { solved_ |= problem_->end(view_, tools_); }
  void set_unsolved() noexcept { solved_.set(StatusFlag::solver_not_converged); }
  ToolRecovery recovery() noexcept { return {view_, *problem_}; }
  /// Updates the error of a tool's force, and its correction.
  void estimate_error(std::size_t tool, bool correct) noexcept;
  /// What is to be reported of a tool at the end of a tick, other than `solved` and `news`.
  Status status_of(std::size_t tool, double stale_after) noexcept;
  /// Passes the forces of the tick to the tissue.
  void give_forces() noexcept;
  void release() noexcept { view_.end_tick({}, {}); }
  void reset() noexcept;

  /// Of the last `take_news`; of all solutions since then.
  Status news() const noexcept { return news_; }
  Status solved() const noexcept { return solved_; }
  RampedValue& friction() noexcept { return friction_; }
  const RampedValue& friction() const noexcept { return friction_; }
  bool may_have_friction() const noexcept { return may_have_friction_; }
  const TissueView& view() const noexcept { return view_; }
  const ContactProblem& problem() const noexcept { return *problem_; }
  ContactProblem& problem() noexcept { return *problem_; }
  std::span<Touch> touches() noexcept { return touches_; }
  std::span<const Touch> touches() const noexcept { return touches_; }
  Touch& touch(std::size_t tool) noexcept { return touches_[tool]; }
  const Touch& touch(std::size_t tool) const noexcept { return touches_[tool]; }
  const CoarseFacetReport& coarse_facets() const noexcept { return coarse_facets_; }
  /// Forces of the tissue on a tool, world frame: those of its contacts, or of a blade [N], [N m].
  Vector3 force_on(std::size_t tool) const noexcept;
  Vector3 torque_on(std::size_t tool) const noexcept;
  /// Where a tool would be without the forces of other tissues, world frame [m].
  Vector3 device_position(std::size_t tool) const noexcept {
    return view_.to_world() * touches_[tool].input.position() - touches_[tool].shift;
  }

 private:
  Touch make_touch(std::size_t tool, const ToolList& tools, const ServoOptions& options);

  TissueView view_;
  ClaimedTissue claimed_;
  std::vector<ContactTool> tools_;
  std::unique_ptr<ContactProblem> problem_;
  CoarseFacetReport coarse_facets_;
  std::vector<Touch> touches_;  // refer to tools_
  RampedValue friction_;
  bool may_have_friction_;
  Status news_, solved_;
  std::uint64_t updates_ = 0;
  bool started_ = false;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/touched_tissue.ipp>
#endif
