// Definitions of haptic_servo.hpp.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/detail/hand.hpp>
#include <palpate/haptic/detail/tool_recovery.hpp>
#include <palpate/haptic/haptic_servo.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

static_assert(Servo<HapticServo>);

inline ToolRadii radii_of(const std::vector<ContactTool>& tools) noexcept {
  ToolRadii radii(no_sphere, 0.0);
  for (const ContactTool& tool : tools) {
    radii.smallest = std::min(radii.smallest, tool.radius);
    if (!(tool.radius < no_sphere)) continue;
    radii.largest = std::max(radii.largest, tool.radius);
    radii.largest_scale = std::max(radii.largest_scale, tool.point_scale());
  }
  return radii;
}
/// The compliance of points finer than facets needs materials that belong to the tissue's compliance.
inline ContactParameters contact_parameters(const TissueView& tissue, ContactParameters parameters) noexcept {
  parameters.subfacet_compliance = parameters.subfacet_compliance && tissue.has_contact_materials();
  return parameters;
}
/// A contact problem on the surface of a tissue, which is prepared for it. Also where all tools are blades: tissue that
/// is cut then makes contact problems like this one, with room for the vertices that a cut adds.
inline std::unique_ptr<ContactProblem> prepared_problem(TissueView& tissue, const std::vector<ContactTool>& tools,
                                                        const ContactParameters& contact) {
  const ContactParameters parameters =
      contact_parameters(tissue, contact.for_tools(tools.size(), tissue.contact_surface().has_large_strain()));
  tissue.prepare_tools(radii_of(tools), parameters);
  return std::make_unique<ContactProblem>(tissue.contact_surface(), radii_of(tools), parameters);
}
inline ToolState unreadable() noexcept {
  ToolState s;
  s.valid = false;
  return s;
}

}  // namespace detail

PALPATE_INLINE HapticServo::HapticServo(const TissueView& tissue, const ToolList& tools, const ServoOptions& options,
                                        const Energy& energy)
    : tissue_(tissue),
      claimed_(tissue_.claim()),
      notes_(tissue_.notes()),
      tools_(tools),
      contact_tools_(detail::make_contact_tools(tools_, options)),
      problem_(detail::prepared_problem(tissue_, contact_tools_, options.contact)),
      coarse_facets_(
          detail::report_coarse_facets(tissue_.contact_surface(), detail::radii_of(contact_tools_).smallest)),
      forces_(tools.size()),
      stale_tissue_after_(options.stale_tissue_after),
      corrected_force_(options.corrected_force) {
  if (tissue_.contact_surface().triangles().empty())
    raise(SetupErrorKind::bad_argument, "this tissue has no touchable surface",
          "Name a surface group with Scene::touch");
  if (!(options.stale_tissue_after > 0.0))
    raise(SetupErrorKind::bad_argument, "stale_tissue_after is " + number(options.stale_tissue_after),
          "It must be positive, in seconds; infinity is allowed");
  check_units();
  hands_.reserve(tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) hands_.push_back(make_hand(i, options, energy));
  Snapshot empty(problem_->capacity());
  empty.tool_count = tools.size();
  snapshots_.fill(empty);
}

PALPATE_INLINE HapticServo::~HapticServo() = default;

PALPATE_INLINE TickView HapticServo::tick_view() const& noexcept {
  return {tissue_, *problem_, hands_.data(), newest_};
}
PALPATE_INLINE const ForceLimits& HapticServo::limits(std::size_t tool) const noexcept {
  return hands_[tool].gate.limits();
}

/// Notes or refuses tools that are larger than a metre.
PALPATE_INLINE void HapticServo::check_units() {
  constexpr double largest = 1.0;  // [m]
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const auto* const blade = std::get_if<BladeTool>(&tools_[i]);
    const double size =
        blade != nullptr ? blade->edge.norm() : contact_tools_[i].radius + contact_tools_[i].half_length;
    if (!(size > largest)) continue;
    SetupProblem problem;
    problem.kind = SetupErrorKind::suspicious_units;
    problem.what = "tool " + std::to_string(i) + " is " + number(size) + " m large: millimetres?";
    problem.hint = "Lengths are metres; or accept it: AdmissionPolicy::units = Admission::accept";
    problem.value = size;
    problem.threshold = largest;
    const auto id = static_cast<std::int64_t>(i);
    problem.set_ids({&id, 1});
    if (tissue_.refuses_suspicious_units()) raise(std::move(problem));
    notes_.push_back(std::move(problem.what));
  }
}

/// Throws unsupported for tissue that cannot be cut.
PALPATE_INLINE std::unique_ptr<detail::ServoBlade> HapticServo::make_blade(const BladeTool& blade, std::size_t tool,
                                                                           const ServoOptions& options) const {
  if (!tissue_.can_be_cut()) {
    SetupProblem problem;
    problem.kind = SetupErrorKind::unsupported;
    problem.what = "this tissue cannot be cut: it has no try_cut(BladeSweep)";
    problem.hint = "Use a CuttableTissue, or touch it with a SphereTool or CapsuleTool";
    const auto id = static_cast<std::int64_t>(tool);
    problem.set_ids({&id, 1});
    raise(std::move(problem));
  }
  return tissue_.make_blade(blade, detail::coupling_stiffness_of(tool, options));
}

PALPATE_INLINE detail::Hand HapticServo::make_hand(std::size_t i, const ServoOptions& options, const Energy& energy) {
  std::unique_ptr<detail::ServoBlade> blade;
  if (const auto* const tool = std::get_if<BladeTool>(&tools_[i])) blade = make_blade(*tool, i, options);
  const ForceLimits limits = options.limits(i);
  const bool rotates = !blade && (contact_tools_[i].half_length > 0.0 || limits.peak_torque > 0.0);
  detail::Hand hand{i, contact_tools_[i], forces_[i],
                    detail::ToolInput(static_cast<int>(i), rotates, options.grasp_buttons), ForceGate(limits)};
  hand.blade = std::move(blade);
  hand.tank = energy;
  if (!energy && options.limit_energy) hand.tank.emplace(EnergyLimits::from(options.device_of(i)));
  return hand;
}

PALPATE_INLINE std::span<const GatedForce> HapticServo::tick(std::span<const ToolState> states) noexcept {
  const FlushDenormals flush;
  Status shared = tissue_.begin_tick(*problem_);
  for (detail::Hand& hand : hands_)
    receive(hand, hand.number < states.size() ? states[hand.number] : detail::unreadable());
  note_updates();
  shared |= problem_->solve(tissue_, contact_tools_);
  const detail::ToolRecovery recovery(tissue_, *problem_);
  if (recovery.sweep_lost_tools(hands_)) shared |= problem_->solve(tissue_, contact_tools_);
  if (recovery.place_lost_tools(hands_)) shared |= problem_->solve(tissue_, contact_tools_);
  for (detail::Hand& hand : hands_) recovery.recover(hand);
  for (detail::Hand& hand : hands_) pass(hand, shared);
  if (tissue_.takes_forces()) tissue_.end_tick(problem_->vertex_forces(), problem_->point_forces());
  publish();
  return forces_;
}

PALPATE_INLINE void HapticServo::reset() noexcept {
  problem_->reset();
  started_ = false;
  updates_ = 0;
  for (detail::Hand& hand : hands_) hand.reset();
  tissue_.end_tick({}, {});
  publish();
}

/// Notes when a tissue that moves by itself was last updated.
PALPATE_INLINE void HapticServo::note_updates() noexcept {
  if (!tissue_.has_updates()) return;
  const std::uint64_t updates = tissue_.updates();
  const bool has_news = !started_ || updates != updates_;
  updates_ = updates;
  started_ = true;
  for (detail::Hand& hand : hands_) hand.input.note_tissue(has_news);
}

PALPATE_INLINE void HapticServo::receive(detail::Hand& hand, const ToolState& state) noexcept {
  if (hand.blade) return receive_blade(*hand.blade, hand.input, state);
  hand.input.receive(state, tissue_.to_world(), tissue_.contact_surface(), problem_->contacts(), hand.tool);
  if (hand.tank) hand.tank->rotated(hand.gate.last_torque().dot(hand.input.rotation()));
}

/// A blade restarts if it moved farther in a tick than the length of its edge.
PALPATE_INLINE void HapticServo::receive_blade(detail::ServoBlade& blade, detail::ToolInput& input,
                                               const ToolState& state) noexcept {
  input.receive_freely(state, tissue_.to_world(), blade.cut().tool().edge.norm());
  if (input.readable())
    blade.follow(tissue_.to_world() * input.position(), input.restarted(), tissue_);
  else
    blade.lift();
}

/// Updates the error of a tool's force; returns the factor of the force. The expected error is subtracted as far as its
/// bound is small: where the tissue deforms otherwise than it was measured (a pinch of a part that a single sphere
/// bends) the bound is as large as the force, and the expected error wrong. The bound stays: it was measured for the
/// force without correction, and the expected error may be too large.
PALPATE_INLINE double HapticServo::estimate_error(detail::Hand& hand) noexcept {
  ForceError& error = hand.error;
  error = hand.blade ? ForceError{0.0, infinity, hand.blade->force().norm()}
                     : problem_->force_error(tissue_, hand.number, hand.tool);
  constexpr double whole = 0.2, none = 0.4;  // bounds, relative to the force
  if (!corrected_force_ || error.expected == 0.0 || hand.tool.grasping) return 1.0;
  const double trusted = std::clamp((none - error.relative()) / (none - whole), 0.0, 1.0);
  const double factor = 1.0 - trusted * error.expected / error.force;
  error.expected *= 1.0 - trusted;
  error.force *= factor;
  return factor;
}

/// Passes the contact force through the energy tank and the gate; the tank then receives the gate's output.
PALPATE_INLINE void HapticServo::pass(detail::Hand& hand, Status shared) noexcept {
  const ContactTool& tool = hand.tool;
  const detail::ToolInput& input = hand.input;
  const Eigen::Isometry3d& pose = tissue_.to_world();
  Vector3 force(0.0, 0.0, 0.0), torque(0.0, 0.0, 0.0);
  if (hand.blade) force = hand.blade->force();
  const double factor = estimate_error(hand);
  if (tool.active) force = factor * (rotation_of(pose) * tool.force);
  if (tool.active && input.rotates()) torque = factor * (rotation_of(pose) * tool.torque);
  Status limited = hand.blade ? hand.blade->status() : Status{};
  if (hand.tank) {
    if (!input.readable() || input.restarted()) hand.tank->forget();
    force = hand.tank->limit(force, pose * input.position(), input.time(), limited);
    torque *= hand.tank->gain();
  }
  const double time = tissue_.has_updates() ? input.stamp(stale_tissue_after_) : input.time();
  hand.force = hand.gate.apply(force, torque, input.now(), time, input.readable(), input.restarted());
  if (hand.tank) hand.tank->gave(hand.force.force());
  hand.force.status |= shared | limited | status_of(hand);
  hand.force.error = hand.error;
}

/// What is to be reported of a tool at the end of a tick.
PALPATE_INLINE Status HapticServo::status_of(detail::Hand& hand) noexcept {
  Status status = hand.input.status() | problem_->status_of(hand.number, hand.tool);
  if (tissue_.has_updates() && hand.input.is_stalled(stale_tissue_after_)) status.set(StatusFlag::stalled_tissue);
  hand.lost_contact = !hand.blade && detail::ToolRecovery(tissue_, *problem_).has_lost_contact(hand);
  if (hand.lost_contact) status.set(StatusFlag::lost_contact);
  const ForceErrorParts& parts = hand.error.parts;
  const double large = ContactProblem::flagged_error * problem_->scale_of_force(hand.number, hand.error.force);
  const auto is_large = [&](double part) { return part > large && part < infinity; };
  if (is_large(parts.mesh)) status.set(StatusFlag::coarse_contact);
  if (is_large(parts.merged) && problem_->has_fewer_points(hand.number)) status.set(StatusFlag::degraded_model);
  if (is_large(parts.linearity)) status.set(StatusFlag::large_displacement);
  return status;
}

PALPATE_INLINE void HapticServo::publish() noexcept {
  const TickView view = tick_view();
  Snapshot& s = snapshots_.back();
  s.note(problem_->contacts(), problem_->vertex_forces(), tissue_.to_world());
  for (const detail::Hand& hand : hands_) {
    const std::size_t i = hand.number;
    s.proxies[i] = view.proxy(i);
    s.axes[i] = view.proxy_axis(i);
    s.errors[i] = hand.error;
    if (hand.tool.hull != nullptr) s.rotations[i] = view.proxy_rotation(i);
    if (hand.blade) s.note_blade(static_cast<int>(i), s.proxies[i], hand.blade->force());
  }
  s.time = hands_.front().input.time();
  newest_ = &s;
  snapshots_.publish();
}

}}  // namespace palpate
