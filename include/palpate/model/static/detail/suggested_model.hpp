// A composition that `suggest` considers, and what it may cost.
#pragma once

#include <palpate/core/types.hpp>

#include <cstddef>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// What a suggested composition may cost. All positive; infinity: any. Times are processor times of a thread, which an
/// idle machine needs.
struct SuggestBudget {
  double tick_seconds = 500e-6;  ///< 99 of 100 ticks, while the tool presses
  double setup_seconds = 5.0;
  double error = 0.0;    ///< wanted error of the force, relative, at all points; 0: as small as possible
  double seconds = 5.0;  ///< for the suggestion itself: what would end later is not tried, or cancelled
  int places = 3;        ///< of the touchable surface where the tool is pressed
};

/// A composition of element and mesh with `Condensed<SelectiveInverse>`, and what was measured of it.
struct SuggestedModel {
  std::string element;    ///< "Tet4", "Smoothed<Tet4>" or "Tet10"
  double edge = 0.0;      ///< of `refine_near_touched` [m]; 0: the mesh as given
  bool measured = false;  ///< else `remark` has the reason, and the figures below may be 0
  double error = 0.0;     ///< AccuracyReport::typical, against a fine mesh
  double largest = 0.0;   ///< AccuracyReport::largest, without its sign: what is compared with the wanted error
  double tick = 0.0;      ///< p99 of the processor time of ticks that press by half of the radius [s]
  double setup = 0.0;     ///< processor time of the set-up, refinement included [s]
  std::size_t bytes = 0;  ///< of stiffness, solver and compliance
  Index nodes = 0, kept_dofs = 0;
  std::string remark;  ///< why it was not measured, or is not within the budget

  std::string name() const;
};

}}}  // namespace palpate::detail
