// Definitions of haptic_servo.hpp.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/detail/blade_cut.hpp>
#include <palpate/contact/detail/servo_blade.hpp>
#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/detail/tool_input.hpp>
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
inline bool is_zero(const Vector3& v) noexcept {
  return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
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
      errors_(tools.size()),
      stale_tissue_after_(options.stale_tissue_after),
      corrected_force_(options.corrected_force),
      lost_contact_(tools.size(), false) {
  if (tissue_.contact_surface().triangles().empty())
    raise(SetupErrorKind::bad_argument, "this tissue has no touchable surface",
          "Name a surface group with Scene::touch");
  if (!(options.stale_tissue_after > 0.0))
    raise(SetupErrorKind::bad_argument, "stale_tissue_after is " + number(options.stale_tissue_after),
          "It must be positive, in seconds; infinity is allowed");
  check_units();
  blades_.resize(tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (const auto* blade = std::get_if<BladeTool>(&tools[i])) add_blade(*blade, i, options);
    gates_.emplace_back(options.limits(i));
    if (energy || options.limit_energy)
      energies_.push_back(energy ? *energy : EnergyTank(EnergyLimits::from(options.device_of(i))));
    const bool rotates = !blades_[i] && (contact_tools_[i].half_length > 0.0 || gates_[i].limits().peak_torque > 0.0);
    inputs_.emplace_back(static_cast<int>(i), rotates, options.grasp_buttons);
  }
  Snapshot empty(problem_->capacity());
  empty.tool_count = tools.size();
  snapshots_.fill(empty);
}

PALPATE_INLINE HapticServo::~HapticServo() = default;

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

PALPATE_INLINE void HapticServo::add_blade(const BladeTool& blade, std::size_t tool, const ServoOptions& options) {
  if (!tissue_.can_be_cut()) {
    SetupProblem problem;
    problem.kind = SetupErrorKind::unsupported;
    problem.what = "this tissue cannot be cut: it has no try_cut(BladeSweep)";
    problem.hint = "Use a CuttableTissue, or touch it with a SphereTool or CapsuleTool";
    const auto id = static_cast<std::int64_t>(tool);
    problem.set_ids({&id, 1});
    raise(std::move(problem));
  }
  blades_[tool] = tissue_.make_blade(blade, detail::coupling_stiffness_of(tool, options));
}

PALPATE_INLINE std::span<const GatedForce> HapticServo::tick(std::span<const ToolState> states) noexcept {
  const FlushDenormals flush;
  Status shared = tissue_.begin_tick(*problem_);
  for (std::size_t i = 0; i < inputs_.size(); ++i) take(i, i < states.size() ? states[i] : detail::unreadable());
  note_updates();
  shared |= problem_->solve(tissue_, contact_tools_);
  if (sweep_lost_tools()) shared |= problem_->solve(tissue_, contact_tools_);
  if (place_lost_tools()) shared |= problem_->solve(tissue_, contact_tools_);
  for (std::size_t i = 0; i < inputs_.size(); ++i) recover(i);
  for (std::size_t i = 0; i < inputs_.size(); ++i) pass(i, shared);
  if (tissue_.takes_forces()) tissue_.end_tick(problem_->vertex_forces(), problem_->point_forces());
  publish();
  return forces_;
}

PALPATE_INLINE void HapticServo::reset() noexcept {
  problem_->reset();
  started_ = false;
  updates_ = 0;
  for (detail::ToolInput& input : inputs_) input.reset();
  for (ContactTool& tool : contact_tools_) tool.reset();
  for (auto& blade : blades_)
    if (blade) blade->reset();
  for (ForceGate& gate : gates_) gate.reset();
  std::fill(errors_.begin(), errors_.end(), ForceError{});
  std::fill(lost_contact_.begin(), lost_contact_.end(), false);
  tissue_.end_tick({}, {});
  for (EnergyTank& energy : energies_) energy.reset();
  publish();
}

PALPATE_INLINE double HapticServo::missing_depth() const noexcept {
  return problem_->missing_depth();
}
PALPATE_INLINE int HapticServo::contact_rows() const noexcept {
  return static_cast<int>(problem_->contacts().size());
}
PALPATE_INLINE double HapticServo::indentation(std::size_t tool) const noexcept {
  return problem_->indentation(tool, contact_tools_[tool]);
}
PALPATE_INLINE bool HapticServo::is_holding(std::size_t tool) const noexcept {
  return problem_->is_holding(tool);
}
PALPATE_INLINE const detail::BladeCut* HapticServo::blade(std::size_t tool) const noexcept {
  return blades_[tool] ? &blades_[tool]->cut() : nullptr;
}
PALPATE_INLINE Vector3 HapticServo::proxy(std::size_t tool) const noexcept {
  return blades_[tool] ? blades_[tool]->cut().edge() : Vector3(tissue_.to_world() * contact_tools_[tool].proxy);
}
PALPATE_INLINE Vector3 HapticServo::contact_force(std::size_t tool) const noexcept {
  return blades_[tool] ? blades_[tool]->force() : Vector3(rotation_of(tissue_.to_world()) * contact_tools_[tool].force);
}
PALPATE_INLINE Vector3 HapticServo::contact_torque(std::size_t tool) const noexcept {
  return rotation_of(tissue_.to_world()) * contact_tools_[tool].torque;
}
PALPATE_INLINE Vector3 HapticServo::proxy_axis(std::size_t tool) const noexcept {
  if (blades_[tool]) return blades_[tool]->cut().tool().edge.normalized();
  return rotation_of(tissue_.to_world()) * contact_tools_[tool].axis();
}

PALPATE_INLINE Matrix3 HapticServo::proxy_rotation(std::size_t tool) const noexcept {
  if (blades_[tool]) return Matrix3::Identity();
  return rotation_of(tissue_.to_world()) * contact_tools_[tool].rotation;
}

/// Notes when a tissue that moves by itself was last updated.
PALPATE_INLINE void HapticServo::note_updates() noexcept {
  if (!tissue_.has_updates()) return;
  const std::uint64_t updates = tissue_.updates();
  const bool has_news = !started_ || updates != updates_;
  updates_ = updates;
  started_ = true;
  for (detail::ToolInput& input : inputs_) input.note_tissue(has_news);
}

PALPATE_INLINE void HapticServo::take(std::size_t i, const ToolState& state) noexcept {
  if (blades_[i]) return take_blade(*blades_[i], i, state);
  inputs_[i].take(state, tissue_.to_world(), tissue_.contact_surface(), problem_->contacts(), contact_tools_[i]);
  if (!energies_.empty()) energies_[i].rotated(gates_[i].last_torque().dot(inputs_[i].rotation()));
}

/// A blade restarts if it moved farther in a tick than the length of its edge.
PALPATE_INLINE void HapticServo::take_blade(detail::ServoBlade& blade, std::size_t i, const ToolState& state) noexcept {
  detail::ToolInput& input = inputs_[i];
  input.take_freely(state, tissue_.to_world(), blade.cut().tool().edge.norm());
  if (input.readable())
    blade.follow(tissue_.to_world() * input.position(), input.restarted(), tissue_);
  else
    blade.lift();
}

/// Notes whether a tool without force overlaps a part of the body that cannot be touched, and returns whether its proxy
/// is inside the body without any contact, and got there through the touchable surface. A
/// tool that entered elsewhere passes until it is outside again.
PALPATE_INLINE bool HapticServo::is_lost(std::size_t i) noexcept {
  const ContactTool& tool = contact_tools_[i];
  detail::ToolInput& input = inputs_[i];
  if (!tool.active || !detail::is_zero(tool.force)) return false;
  const ContactSurface& surface = tissue_.contact_surface();
  input.set_beside_surface(false);
  if (input.is_clear(surface.revision(), tool.proxy)) return false;
  bool inside = false, behind = false, beside = false;
  double least = infinity;
  detail::for_each_probe(tool, [&](const Vector3& probe) {
    const Vector3 centre = tool.half_length > 0.0 ? tool.proxy + tool.rotation * probe : tool.proxy;
    const double distance = surface.distance_of_body(centre);
    least = std::min(least, distance);
    beside = beside || (surface.has_shell() && distance < (1.0 - 1e-3) * tool.radius &&
                        surface.closest_of_body(centre).triangle < 0);
    if (!(distance < 0.0) || is_free(centre, -distance)) return;
    inside = true;
    behind = behind || surface.closest_of_body(centre).triangle >= 0;
  });
  input.set_beside_surface(beside);
  const double reach = 2.0 * tool.half_length + (surface.has_shell() ? tool.radius : 0.0);
  input.set_clearance(surface.revision(), tool.proxy, surface.is_closed() ? least - reach : 0.0);
  const bool lost = inside && behind && !input.is_passing();
  if (!lost) input.set_passing(inside);
  return lost;
}

/// Whether forces have moved the surface so far that a position inside the resting body is outside now.
PALPATE_INLINE bool HapticServo::is_free(const Vector3& position, double depth) noexcept {
  return !problem_->vertex_forces().empty() && problem_->closest(tissue_, position, depth).distance > 0.0;
}

/// Whether nothing presses a tool any more but the linearisations of the tick ended before it reached its device.
PALPATE_INLINE bool HapticServo::is_on_the_way(std::size_t i) const noexcept {
  constexpr double near = 1e-6;  // radii
  const ContactTool& tool = contact_tools_[i];
  return tool.active && detail::is_zero(tool.force) && (tool.target - tool.proxy).norm() > near * tool.radius;
}

/// Lost tools are swept again from where they were outside, and tools on the way the rest of it; true if there are any.
PALPATE_INLINE bool HapticServo::sweep_lost_tools() noexcept {
  const ContactSurface& surface = tissue_.contact_surface();
  bool any = false;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    ContactTool& tool = contact_tools_[i];
    if (is_lost(i)) {
      any = inputs_[i].sweep_from_outside(surface, tool) || any;
    } else if (is_on_the_way(i)) {
      detail::sweep(tool, surface, tool.proxy, tool.target);
      any = true;
    }
  }
  return any;
}

/// Spheres that are still lost are placed beside the surface as the other tools deform it; true if there are any.
PALPATE_INLINE bool HapticServo::place_lost_tools() noexcept {
  bool any = false;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    ContactTool& tool = contact_tools_[i];
    if (tool.half_length > 0.0 || problem_->vertex_forces().empty() || !is_lost(i)) continue;
    const double depth = tissue_.contact_surface().distance_of_body(tool.target);
    const auto closest = problem_->closest(tissue_, tool.target, std::abs(depth));
    if (closest.triangle < 0) continue;
    tool.proxy = closest.point + tool.radius * closest.outward;
    any = true;
  }
  return any;
}

/// A tool that is lost even so is placed on the resting surface in the next tick, with the ramp.
PALPATE_INLINE void HapticServo::recover(std::size_t i) noexcept {
  if (is_lost(i))
    inputs_[i].lose();
  else if (!inputs_[i].is_passing())
    inputs_[i].note_outside(problem_->contacts(), contact_tools_[i]);
}

/// Whether a tool is inside the body or beside what can be touched of it without a force, is pushed by facets that it
/// has passed, or presses beyond the rim. Remains true until no such facet pushes and the tool is outside the deformed
/// body. Call it at the end of a tick, after `recover`.
PALPATE_INLINE bool HapticServo::has_lost_contact(std::size_t i) noexcept {
  constexpr double most_from_behind = 0.1, most_on_rim = 0.2;
  const ContactTool& tool = contact_tools_[i];
  if (!tool.active) return false;
  if (detail::is_zero(tool.force))
    return inputs_[i].is_passing() || inputs_[i].is_lost() || inputs_[i].is_beside_surface();
  if (problem_->force_from_behind(tissue_, i) > most_from_behind) return true;
  if (problem_->force_on_rim(tissue_, i) > most_on_rim) return true;
  if (!lost_contact_[i]) return false;
  const double distance = tissue_.contact_surface().distance_of_body(tool.proxy);
  return distance < 0.0 && !is_free(tool.proxy, -distance);
}

/// Updates the error of a tool's force; returns the factor of the force. The expected error is subtracted as far as its
/// bound is small: where the tissue deforms otherwise than it was measured (a pinch of a part that a single sphere
/// bends) the bound is as large as the force, and the expected error wrong. The bound stays: it was measured for the
/// force without correction, and the expected error may be too large.
PALPATE_INLINE double HapticServo::estimate_error(std::size_t i) noexcept {
  ForceError& error = errors_[i];
  error = blades_[i] ? ForceError{0.0, infinity, blades_[i]->force().norm()}
                     : problem_->force_error(tissue_, i, contact_tools_[i]);
  constexpr double whole = 0.2, none = 0.4;  // bounds, relative to the force
  if (!corrected_force_ || error.expected == 0.0 || contact_tools_[i].grasping) return 1.0;
  const double trusted = std::clamp((none - error.relative()) / (none - whole), 0.0, 1.0);
  const double factor = 1.0 - trusted * error.expected / error.force;
  error.expected *= 1.0 - trusted;
  error.force *= factor;
  return factor;
}

/// Passes the contact force through the energy tank and the gate; the tank then receives the gate's output.
PALPATE_INLINE void HapticServo::pass(std::size_t i, Status shared) noexcept {
  const ContactTool& tool = contact_tools_[i];
  const detail::ToolInput& input = inputs_[i];
  EnergyTank* const energy = energies_.empty() ? nullptr : &energies_[i];
  const Eigen::Isometry3d& pose = tissue_.to_world();
  Vector3 force(0.0, 0.0, 0.0), torque(0.0, 0.0, 0.0);
  if (blades_[i]) force = blades_[i]->force();
  const double factor = estimate_error(i);
  if (tool.active) force = factor * (rotation_of(pose) * tool.force);
  if (tool.active && input.rotates()) torque = factor * (rotation_of(pose) * tool.torque);
  Status limited = blades_[i] ? blades_[i]->status() : Status{};
  if (energy != nullptr) {
    if (!input.readable() || input.restarted()) energy->forget();
    force = energy->limit(force, pose * input.position(), input.time(), limited);
    torque *= energy->gain();
  }
  const double time = tissue_.has_updates() ? input.stamp(stale_tissue_after_) : input.time();
  forces_[i] = gates_[i].apply(force, torque, input.now(), time, input.readable(), input.restarted());
  if (energy != nullptr) energy->gave(forces_[i].force());
  forces_[i].status |= input.status() | shared | limited | problem_->status_of(i, tool);
  if (tissue_.has_updates() && input.is_stalled(stale_tissue_after_)) forces_[i].status.set(StatusFlag::stalled_tissue);
  lost_contact_[i] = !blades_[i] && has_lost_contact(i);
  if (lost_contact_[i]) forces_[i].status.set(StatusFlag::lost_contact);
  const ForceError& error = errors_[i];
  const double large = ContactProblem::flagged_error * problem_->scale_of_force(i, error.force);
  const auto is_large = [&](double part) { return part > large && part < infinity; };
  if (is_large(error.parts.mesh)) forces_[i].status.set(StatusFlag::coarse_contact);
  if (is_large(error.parts.merged) && problem_->has_fewer_points(i)) forces_[i].status.set(StatusFlag::degraded_model);
  if (is_large(error.parts.linearity)) forces_[i].status.set(StatusFlag::large_displacement);
  forces_[i].error = error;
}

PALPATE_INLINE void HapticServo::publish() noexcept {
  Snapshot& s = snapshots_.back();
  s.note(problem_->contacts(), problem_->vertex_forces(), tissue_.to_world());
  for (std::size_t i = 0; i < contact_tools_.size(); ++i) {
    s.proxies[i] = proxy(i);
    s.axes[i] = proxy_axis(i);
    s.errors[i] = errors_[i];
    if (contact_tools_[i].hull != nullptr) s.rotations[i] = proxy_rotation(i);
    if (blades_[i]) s.note_blade(static_cast<int>(i), s.proxies[i], blades_[i]->force());
  }
  s.time = inputs_.front().time();
  newest_ = &s;
  snapshots_.publish();
}

}}  // namespace palpate
