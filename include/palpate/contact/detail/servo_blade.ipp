// Definitions of servo_blade.hpp.
#pragma once

#include <palpate/contact/detail/blade_inside.hpp>
#include <palpate/contact/detail/servo_blade.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/core/rigid_motion.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE ServoBlade::ServoBlade(const BladeTool& tool, double stiffness)
    : follow_([](ServoBlade& blade, const Vector3& hand, bool restart, const TissueView& tissue) noexcept {
        blade.advance(hand, restart, tissue);
      }),
      cut_(tool, stiffness) {}

PALPATE_INLINE void ServoBlade::advance(const Vector3& hand, bool restart, const TissueView& tissue) noexcept {
  status_ = {};
  if (restart) cut_.lift();
  const Vector3 before = cut_.edge();
  force_ = cut_.advance(hand, restart ? 0.0 : width_inside(tissue));
  if (restart) ordered_ = cut_.edge();
  if (!restart && cut_.cut_from() != before) {  // through a slit, or out of the tissue: no cut between
    if (order_cut(before, tissue, 1e-3 * cut_.tool().cut_spacing)) ordered_ = cut_.cut_from();
  }
  if (!order_cut(cut_.edge(), tissue, cut_.tool().cut_spacing)) status_.set(StatusFlag::degraded_model);
}

PALPATE_INLINE void ServoBlade::reset() noexcept {
  cut_.reset();
  force_.setZero();
  ordered_.setZero();
  status_ = {};
}

/// Length of the edge in tissue [m].
PALPATE_INLINE double ServoBlade::width_inside(const TissueView& tissue) const noexcept {
  const Eigen::Isometry3d to_model = inverse(tissue.to_world());
  const Vector3 half = 0.5 * cut_.tool().edge;
  return length_in_tissue(tissue.contact_surface(), to_model * (cut_.edge() - half), to_model * (cut_.edge() + half),
                          cut_.tool().cut_spacing);
}

/// Requests a cut along the surface swept since the last request to an edge at `to`, unless its path is shorter than
/// `least`; false when the tissue cannot accept it yet.
PALPATE_INLINE bool ServoBlade::order_cut(const Vector3& to, const TissueView& tissue, double least) noexcept {
  if ((to - ordered_).norm() < least) return true;
  const Vector3 half = 0.5 * cut_.tool().edge;
  if (!tissue.try_cut({ordered_ - half, ordered_ + half, to - half, to + half})) return false;
  ordered_ = to;
  return true;
}

PALPATE_INLINE std::unique_ptr<ServoBlade> make_blade(const BladeTool& tool, double stiffness) {
  return std::make_unique<ServoBlade>(tool, stiffness);
}

}}}  // namespace palpate::detail
