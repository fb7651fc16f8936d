// Tools that have lost the surface are put back on it.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/haptic/detail/touch.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// What a servo does with tools inside the body that nothing presses. Each of the first two functions moves proxies, so
/// that the contact problem is to be solved again if it returns true. Everything runs in the tick: no throw, no
/// allocation.
class ToolRecovery {
 public:
  ToolRecovery(const TissueView& tissue, ContactProblem& problem) noexcept : tissue_(tissue), problem_(problem) {}

  /// Lost tools are swept again from where they were outside, and tools on the way the rest of it; true if there are
  /// any.
  bool sweep_lost_tools(std::span<Touch> touches) const noexcept;
  /// Spheres that are still lost are placed beside the surface as the other tools deform it; true if there are any.
  bool place_lost_tools(std::span<Touch> touches) const noexcept;
  /// A tool that is lost even so is placed on the resting surface in the next tick, with the ramp.
  void recover(Touch& touch) const noexcept;
  /// Whether a tool is inside the body or beside what can be touched of it without a force, is pushed by facets that it
  /// has passed, or presses beyond the rim. Remains true until no such facet pushes and the tool is outside the
  /// deformed body. Call it at the end of a tick, after `recover`.
  bool has_lost_contact(const Touch& touch) const noexcept;

 private:
  bool is_lost(Touch& touch) const noexcept;
  bool is_free(const Vector3& position, double depth) const noexcept;

  const TissueView& tissue_;
  ContactProblem& problem_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/tool_recovery.ipp>
#endif
