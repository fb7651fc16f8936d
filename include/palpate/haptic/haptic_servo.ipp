// Definitions of haptic_servo.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/detail/hand.hpp>
#include <palpate/haptic/detail/require_index.hpp>
#include <palpate/haptic/detail/shared_tools.hpp>
#include <palpate/haptic/detail/tool_recovery.hpp>
#include <palpate/haptic/detail/touched_tissue.hpp>
#include <palpate/haptic/haptic_servo.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

static_assert(Servo<HapticServo>);

inline ToolState unreadable() noexcept {
  ToolState s;
  s.valid = false;
  return s;
}

/// The tissues of a servo, with their notes.
inline std::vector<TouchedTissue> touched_tissues(std::span<const GroupMember> members, const ToolList& tools,
                                                  const ServoOptions& options) {
  if (members.empty()) raise(SetupErrorKind::bad_argument, "a TissueGroup has no tissues");
  for (std::size_t k = 1; k < members.size(); ++k)
    for (std::size_t other = 0; other < k; ++other)
      if (members[k].tissue.is_same(members[other].tissue))
        raise(SetupErrorKind::bad_argument,
              "tissues " + std::to_string(other) + " and " + std::to_string(k) + " of a TissueGroup are one");
  std::vector<TouchedTissue> made;
  made.reserve(members.size());
  for (const GroupMember& member : members) made.emplace_back(member, tools, options);
  return made;
}
inline std::vector<std::string> notes_of(std::span<const GroupMember> members) {
  std::vector<std::string> all;
  for (const GroupMember& member : members)
    for (std::string& note : member.tissue.notes()) all.push_back(std::move(note));
  return all;
}

}  // namespace detail

PALPATE_INLINE HapticServo::HapticServo(Members members, const ToolList& tools, const ServoOptions& options,
                                        const Energy& energy, const detail::SharedTools* shared)
    : tools_(tools),
      tissues_(detail::touched_tissues(members, tools_, options)),
      shared_(members.size() > 1 ? shared : nullptr),
      notes_(detail::notes_of(members)),
      forces_(tools.size()),
      stale_tissue_after_(options.stale_tissue_after),
      force_tolerance_(options.contact.force_tolerance),
      ramp_ticks_(static_cast<int>(std::clamp(0.1 * options.tick_rate(), 1.0, 1e6))),
      corrected_force_(options.corrected_force) {
  if (!(options.stale_tissue_after > 0.0))
    raise(SetupErrorKind::bad_argument, "stale_tissue_after is " + number(options.stale_tissue_after),
          "It must be positive, in seconds; infinity is allowed");
  check_units();
  check_blades();
  hands_.reserve(tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) hands_.push_back(make_hand(i, options, energy));
  int capacity = 0;
  for (const detail::TouchedTissue& tissue : tissues_) capacity += tissue.problem().capacity();
  Snapshot empty(capacity, tissues_.size());
  empty.tool_count = tools.size();
  snapshots_.fill(empty);
}

PALPATE_INLINE HapticServo::~HapticServo() = default;

PALPATE_INLINE std::size_t HapticServo::tissue_count() const noexcept {
  return tissues_.size();
}
PALPATE_INLINE TickView HapticServo::tick_view() const& noexcept {
  return {tissues_, hands_.data(), newest_};
}
PALPATE_INLINE const ForceLimits& HapticServo::limits(std::size_t tool) const noexcept {
  return hands_[tool].gate.limits();
}
PALPATE_INLINE const CoarseFacetReport& HapticServo::coarse_facets(std::size_t tissue) const noexcept {
  return tissues_[tissue].coarse_facets();
}

/// Notes or refuses tools that are larger than a metre.
PALPATE_INLINE void HapticServo::check_units() {
  constexpr double largest = 1.0;  // [m]
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const auto* const blade = std::get_if<BladeTool>(&tools_[i]);
    const ContactTool& tool = tissues_.front().touch(i).tool;
    const double size = blade != nullptr ? blade->edge.norm() : tool.radius + tool.half_length;
    if (!(size > largest)) continue;
    SetupProblem problem;
    problem.kind = SetupErrorKind::suspicious_units;
    problem.what = "tool " + std::to_string(i) + " is " + number(size) + " m large: millimetres?";
    problem.hint = "Lengths are metres; or accept it: AdmissionPolicy::units = Admission::accept";
    problem.value = size;
    problem.threshold = largest;
    const auto id = static_cast<std::int64_t>(i);
    problem.set_ids({&id, 1});
    for (const detail::TouchedTissue& tissue : tissues_)
      if (tissue.view().refuses_suspicious_units()) raise(std::move(problem));
    notes_.push_back(std::move(problem.what));
  }
}

/// Throws unsupported for a blade and no tissue that can be cut.
PALPATE_INLINE void HapticServo::check_blades() const {
  for (const detail::TouchedTissue& tissue : tissues_)
    if (tissue.view().can_be_cut()) return;
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    if (std::get_if<BladeTool>(&tools_[i]) == nullptr) continue;
    SetupProblem problem;
    problem.kind = SetupErrorKind::unsupported;
    problem.what = "this tissue cannot be cut: it has no try_cut(BladeSweep)";
    problem.hint = "Use a CuttableTissue, or touch it with a SphereTool or CapsuleTool";
    const auto id = static_cast<std::int64_t>(i);
    problem.set_ids({&id, 1});
    raise(std::move(problem));
  }
}

PALPATE_INLINE detail::Hand HapticServo::make_hand(std::size_t i, const ServoOptions& options, const Energy& energy) {
  detail::Hand hand{i, forces_[i], ForceGate(options.limits(i)),
                    detail::RampedValue(1.0 / detail::coupling_stiffness_of(i, options))};
  for (std::size_t k = tissues_.size(); k-- > 0;)
    if (tissues_[k].touch(i).blade || !tissues_[k].touch(i).is_blade) hand.tissue = hand.first_tissue = k;
  hand.tank = energy;
  if (!energy && options.limit_energy) hand.tank.emplace(EnergyLimits::from(options.device_of(i)));
  return hand;
}

PALPATE_INLINE std::span<const GatedForce> HapticServo::tick(std::span<const ToolState> states) noexcept {
  const FlushDenormals flush;
  for (detail::TouchedTissue& tissue : tissues_) tissue.take_news();
  follow_parameters();
  receive(states);
  for (detail::TouchedTissue& tissue : tissues_) tissue.note_updates();
  solve();
  recover();
  for (detail::Hand& hand : hands_) pass(hand);
  for (detail::TouchedTissue& tissue : tissues_) tissue.give_forces();
  publish();
  return forces_;
}

PALPATE_INLINE void HapticServo::reset() noexcept {
  for (detail::TouchedTissue& tissue : tissues_) tissue.reset();
  for (detail::Hand& hand : hands_) hand.reset();
  publish();
}

PALPATE_INLINE void HapticServo::release() noexcept {
  for (detail::TouchedTissue& tissue : tissues_) tissue.release();
}

PALPATE_INLINE void HapticServo::set_friction(double coefficient, std::size_t tissue) {
  detail::require_index(tissue, tissues_.size(), "tissue");
  detail::RampedValue& friction = tissues_[tissue].friction();
  if (!(coefficient >= 0.0 && coefficient <= 4.0))
    raise(SetupErrorKind::bad_argument, "the coefficient of friction is " + number(coefficient), "Give 0 to 4");
  if (!tissues_[tissue].may_have_friction() && coefficient > 0.0)
    raise(SetupErrorKind::unsupported, "friction in a servo that was made without",
          "Set ServoOptions::contact.friction, or that of the tissue in its group, to a value above zero");
  friction.set(coefficient);
}
PALPATE_INLINE double HapticServo::friction(std::size_t tissue) const noexcept {
  return tissues_[tissue].friction().wanted();
}

PALPATE_INLINE void HapticServo::set_coupling_stiffness(double stiffness, std::size_t tool) {
  detail::require_index(tool, hands_.size(), "tool");
  if (std::get_if<BladeTool>(&tools_[tool]) != nullptr)
    raise(SetupErrorKind::unsupported, "another coupling for a blade", "Make another servo");
  ServoOptions options;
  options.coupling_stiffness = stiffness;
  hands_[tool].compliance.set(1.0 / detail::coupling_stiffness_of(0, options));
}
PALPATE_INLINE double HapticServo::coupling_stiffness(std::size_t tool) const noexcept {
  return 1.0 / hands_[tool].compliance.wanted();
}

PALPATE_INLINE void HapticServo::follow_parameters() noexcept {
  for (detail::TouchedTissue& tissue : tissues_) tissue.follow_parameters(ramp_ticks_);
  for (detail::Hand& hand : hands_) {
    const double compliance = hand.compliance.next(ramp_ticks_);
    for (detail::TouchedTissue& tissue : tissues_) tissue.touch(hand.number).tool.compliance = compliance;
  }
}

PALPATE_INLINE void HapticServo::receive(std::span<const ToolState> states) noexcept {
  for (detail::Hand& hand : hands_) {
    const std::size_t i = hand.number;
    const ToolState state = i < states.size() ? states[i] : detail::unreadable();
    for (std::size_t k = 0; k < tissues_.size(); ++k)
      tissues_[k].receive(i, shared_ == nullptr ? state : shared_->moved(tissues_, k, i, state));
    const detail::Touch& touch = tissues_.front().touch(i);
    if (hand.tank && !touch.is_blade)
      hand.tank->rotated(hand.gate.last_torque().dot(touch.input.rotation() - touch.rotation_change));
  }
}

PALPATE_INLINE void HapticServo::solve() noexcept {
  if (shared_ == nullptr) return tissues_.front().solve();
  shared_->solve(tissues_, force_tolerance_);
}

/// Puts tools that have lost a surface back on it.
PALPATE_INLINE void HapticServo::recover() noexcept {
  bool swept = false, placed = false;
  for (detail::TouchedTissue& tissue : tissues_) swept = tissue.recovery().sweep_lost_tools(tissue.touches()) || swept;
  if (swept) solve();
  for (detail::TouchedTissue& tissue : tissues_)
    placed = tissue.recovery().place_lost_tools(tissue.touches()) || placed;
  if (placed) solve();
  for (detail::TouchedTissue& tissue : tissues_)
    for (detail::Touch& touch : tissue.touches()) tissue.recovery().recover(touch);
}

/// The error of the force of all tissues that press a tool: bounds add up, expected errors count as far as they are
/// along the force. A tool that nothing presses has the largest of the errors.
PALPATE_INLINE void HapticServo::add_errors(detail::Hand& hand, const Vector3& force) noexcept {
  if (tissues_.size() == 1) {
    hand.error = tissues_.front().touch(hand.number).error;
    return;
  }
  hand.error = {0.0, 0.0, force.norm(), {0.0}};
  double largest = 0.0;
  for (const detail::TouchedTissue& tissue : tissues_) largest = std::max(largest, tissue.force_on(hand.number).norm());
  for (const detail::TouchedTissue& tissue : tissues_) {
    const ForceError& own = tissue.touch(hand.number).error;
    const Vector3 pressing = tissue.force_on(hand.number);
    const double length = pressing.norm();
    if (largest > 0.0 ? !(length > 0.0) : !(own.bound > hand.error.bound)) continue;
    if (largest == 0.0) {
      hand.error = own;
      continue;
    }
    if (hand.error.force > 0.0) hand.error.expected += own.expected * pressing.dot(force) / (length * hand.error.force);
    hand.error.bound += own.bound;
    hand.error.parts += own.parts;
  }
}

PALPATE_INLINE bool HapticServo::is_pressed(std::size_t tool) const noexcept {
  for (const detail::TouchedTissue& tissue : tissues_)
    if (tissue.touch(tool).presses()) return true;
  return false;
}

/// The flags of the tissues that press a tool, or of all where none does, and of all tissues those of its input and of
/// the solution. After the errors are estimated.
PALPATE_INLINE Status HapticServo::status_of(std::size_t tool) noexcept {
  const bool is_pressed_by_any = is_pressed(tool);
  Status status;
  for (detail::TouchedTissue& tissue : tissues_) {
    const detail::Touch& touch = tissue.touch(tool);
    const Status own = tissue.news() | tissue.status_of(tool, stale_tissue_after_);
    status |= tissue.solved();
    if (touch.presses() || !is_pressed_by_any) {
      status |= own;
      continue;
    }
    status |= touch.input.status();
    if (touch.blade) status |= touch.blade->status();
    if (touch.lost_contact) status.set(StatusFlag::lost_contact);
  }
  return status;
}

/// Time of the state of a tool for its gate: that of a tissue stops when it is not updated. Where there are several,
/// only those count that press the tool.
PALPATE_INLINE double HapticServo::time_of(std::size_t tool) const noexcept {
  double time = tissues_.front().touch(tool).input.time();
  for (const detail::TouchedTissue& tissue : tissues_) {
    const detail::Touch& touch = tissue.touch(tool);
    if (tissue.view().has_updates() && (touch.presses() || tissues_.size() == 1))
      time = std::min(time, touch.input.stamp(stale_tissue_after_));
  }
  return time;
}

/// Passes the force of all tissues through the energy tank and the gate; the tank then receives the gate's output.
PALPATE_INLINE void HapticServo::pass(detail::Hand& hand) noexcept {
  const std::size_t i = hand.number;
  const detail::ToolInput& input = tissues_.front().touch(i).input;
  Vector3 force(0.0, 0.0, 0.0), torque(0.0, 0.0, 0.0);
  double most = -1.0;
  bool is_readable = true, has_restarted = false;
  for (std::size_t k = 0; k < tissues_.size(); ++k) {
    detail::TouchedTissue& tissue = tissues_[k];
    const detail::Touch& touch = tissue.touch(i);
    tissue.estimate_error(i, corrected_force_);
    const Vector3 own = touch.correction * tissue.force_on(i);
    force += own;
    if (touch.input.rotates()) torque += touch.correction * tissue.torque_on(i);
    if (own.norm() > most && (!touch.is_blade || touch.blade)) most = own.norm(), hand.tissue = k;
    is_readable = is_readable && touch.input.readable();
    has_restarted = has_restarted || touch.input.restarted();
  }
  add_errors(hand, force);
  Status limited;
  if (hand.tank) {
    if (!is_readable || has_restarted) hand.tank->forget();
    force = hand.tank->limit(force, tissues_.front().device_position(i), input.time(), limited);
    torque *= hand.tank->gain();
  }
  hand.force = hand.gate.apply(force, torque, input.now(), time_of(i), is_readable, has_restarted);
  if (hand.tank) hand.tank->gave(hand.force.force());
  hand.force.status |= status_of(i) | limited;
  hand.force.error = hand.error;
}

PALPATE_INLINE void HapticServo::publish() noexcept {
  const TickView view = tick_view();
  Snapshot& s = snapshots_.back();
  s.clear();
  for (std::size_t k = 0; k < tissues_.size(); ++k) {
    const ContactProblem& problem = tissues_[k].problem();
    s.note(k, problem.contacts(), problem.vertex_forces(), tissues_[k].view().to_world());
  }
  for (const detail::Hand& hand : hands_) {
    const std::size_t i = hand.number;
    s.proxies[i] = view.proxy(i);
    s.axes[i] = view.proxy_axis(i);
    s.errors[i] = hand.error;
    if (tissues_.front().touch(i).tool.hull != nullptr) s.rotations[i] = view.proxy_rotation(i);
    for (std::size_t k = 0; k < tissues_.size(); ++k)
      if (const auto& blade = tissues_[k].touch(i).blade)
        s.note_blade(k, static_cast<int>(i), blade->cut().edge(), blade->force());
  }
  s.time = tissues_.front().touch(0).input.time();
  newest_ = &s;
  snapshots_.publish();
}

}}  // namespace palpate
