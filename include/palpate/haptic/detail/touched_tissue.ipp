// Definitions of touched_tissue.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/detail/touched_tissue.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
inline ContactParameters contact_parameters(const GroupMember& member, ContactParameters parameters,
                                            std::size_t tools) noexcept {
  parameters = parameters.for_tools(tools, member.tissue.contact_surface().has_large_strain());
  parameters.friction = member.friction.value_or(parameters.friction);
  parameters.subfacet_compliance = parameters.subfacet_compliance && member.tissue.has_contact_materials();
  return parameters;
}
/// A contact problem on the surface of a tissue, which is prepared for it. Also where all tools are blades: tissue that
/// is cut then makes contact problems like this one, with room for the vertices that a cut adds.
inline std::unique_ptr<ContactProblem> prepared_problem(TissueView& tissue, const std::vector<ContactTool>& tools,
                                                        const ContactParameters& parameters) {
  tissue.prepare_tools(radii_of(tools), parameters);
  return std::make_unique<ContactProblem>(tissue.contact_surface(), radii_of(tools), parameters);
}

PALPATE_INLINE TouchedTissue::TouchedTissue(const GroupMember& member, const ToolList& tools,
                                            const ServoOptions& options)
    : view_(member.tissue),
      claimed_(view_.claim()),
      tools_(make_contact_tools(tools, options)),
      problem_(prepared_problem(view_, tools_, contact_parameters(member, options.contact, tools.size()))),
      coarse_facets_(report_coarse_facets(view_.contact_surface(), radii_of(tools_).smallest)),
      friction_(member.friction.value_or(options.contact.friction)),
      may_have_friction_(friction_.wanted() > 0.0) {
  if (view_.contact_surface().triangles().empty() && !view_.gains_pieces())
    raise(SetupErrorKind::bad_argument, "this tissue has no touchable surface",
          "Name a surface group with Scene::touch");
  touches_.reserve(tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) touches_.push_back(make_touch(i, tools, options));
}

PALPATE_INLINE Touch TouchedTissue::make_touch(std::size_t i, const ToolList& tools, const ServoOptions& options) {
  const auto* const blade = std::get_if<BladeTool>(&tools[i]);
  const bool rotates = blade == nullptr && (tools_[i].half_length > 0.0 || options.limits(i).peak_torque > 0.0);
  Touch touch{i, tools_[i], ToolInput(static_cast<int>(i), rotates, options.grasp_buttons), blade != nullptr};
  if (blade != nullptr) touch.blade = view_.make_blade(*blade, coupling_stiffness_of(i, options));
  return touch;
}

PALPATE_INLINE void TouchedTissue::follow_parameters(int ramp_ticks) noexcept {
  problem_->set_friction(friction_.next(ramp_ticks));
}

/// A blade restarts if it moved farther in a tick than the length of its edge.
PALPATE_INLINE void TouchedTissue::receive(std::size_t tool, const ToolState& state) noexcept {
  Touch& touch = touches_[tool];
  ToolInput& input = touch.input;
  if (!touch.is_blade)
    return input.receive(state, view_.to_world(), view_.contact_surface(), problem_->contacts(), touch.tool);
  input.receive_freely(state, view_.to_world(), touch.blade ? touch.blade->cut().tool().edge.norm() : infinity);
  if (!touch.blade) return;
  if (input.readable())
    touch.blade->follow(view_.to_world() * input.position(), input.restarted(), view_);
  else
    touch.blade->lift();
}

PALPATE_INLINE void TouchedTissue::note_updates() noexcept {
  if (!view_.has_updates()) return;
  const std::uint64_t updates = view_.updates();
  const bool has_news = !started_ || updates != updates_;
  updates_ = updates;
  started_ = true;
  for (Touch& touch : touches_) touch.input.note_tissue(has_news);
}

/// The expected error is subtracted as far as its bound is small: where the tissue deforms otherwise than it was
/// measured (a pinch of a part that a single sphere bends) the bound is as large as the force, and the expected error
/// wrong. The bound stays: it was measured for the force without correction, and the expected error may be too large.
PALPATE_INLINE void TouchedTissue::estimate_error(std::size_t tool, bool correct) noexcept {
  Touch& touch = touches_[tool];
  ForceError& error = touch.error;
  error = touch.blade ? ForceError{0.0, infinity, touch.blade->force().norm()}
                      : problem_->force_error(view_, tool, touch.tool);
  constexpr double whole = 0.2, none = 0.4;  // bounds, relative to the force
  touch.correction = 1.0;
  if (!correct || error.expected == 0.0 || touch.tool.grasping) return;
  const double trusted = std::clamp((none - error.relative()) / (none - whole), 0.0, 1.0);
  touch.correction = 1.0 - trusted * error.expected / error.force;
  error.expected *= 1.0 - trusted;
  error.force *= touch.correction;
}

PALPATE_INLINE Status TouchedTissue::status_of(std::size_t tool, double stale_after) noexcept {
  Touch& touch = touches_[tool];
  Status status = touch.input.status() | problem_->status_of(tool, touch.tool);
  if (touch.blade) status |= touch.blade->status();
  if (view_.has_updates() && touch.input.is_stalled(stale_after)) status.set(StatusFlag::stalled_tissue);
  touch.lost_contact = !touch.is_blade && recovery().has_lost_contact(touch);
  if (touch.lost_contact) status.set(StatusFlag::lost_contact);
  const ForceErrorParts& parts = touch.error.parts;
  const double large = ContactProblem::flagged_error * problem_->scale_of_force(tool, touch.error.force);
  const auto is_large = [&](double part) { return part > large && part < infinity; };
  if (is_large(parts.mesh)) status.set(StatusFlag::coarse_contact);
  if (is_large(parts.merged) && problem_->has_fewer_points(tool)) status.set(StatusFlag::degraded_model);
  if (is_large(parts.linearity)) status.set(StatusFlag::large_displacement);
  return status;
}

PALPATE_INLINE void TouchedTissue::give_forces() noexcept {
  if (view_.takes_forces()) view_.end_tick(problem_->vertex_forces(), problem_->point_forces());
}

PALPATE_INLINE void TouchedTissue::reset() noexcept {
  problem_->reset();
  started_ = false;
  updates_ = 0;
  news_ = solved_ = {};
  friction_.settle();
  for (Touch& touch : touches_) touch.reset();
  release();
}

PALPATE_INLINE Vector3 TouchedTissue::force_on(std::size_t tool) const noexcept {
  const Touch& touch = touches_[tool];
  return touch.blade ? touch.blade->force() : Vector3(palpate::rotation_of(view_.to_world()) * touch.tool.force);
}
PALPATE_INLINE Vector3 TouchedTissue::torque_on(std::size_t tool) const noexcept {
  return palpate::rotation_of(view_.to_world()) * touches_[tool].tool.torque;
}

}}}  // namespace palpate::detail
