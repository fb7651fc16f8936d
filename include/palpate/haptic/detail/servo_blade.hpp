// A blade of a servo.
#pragma once

#include <palpate/contact/detail/blade_cut.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/core/status.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Follows a hand with a blade and requests cuts along the surface swept by the edge. Everything runs in the tick: no
/// throw, no allocation, bounded.
class ServoBlade {
 public:
  /// Throws bad_argument as BladeCut does.
  ServoBlade(const BladeTool& tool, double stiffness) : cut_(tool, stiffness) {}

  /// Moves with the hand, world frame [m]; `restart`: it starts there again, as if outside the tissue. Requests a cut
  /// along the swept surface once the path since the last request reaches the cut spacing.
  void follow(const Vector3& hand, bool restart, const TissueView& tissue) noexcept;
  /// The position of the hand is lost: no force.
  void lift() noexcept;
  void reset() noexcept;

  const Vector3& force() const noexcept { return force_; }  ///< on the hand, world frame [N]
  Status status() const noexcept { return status_; }        ///< degraded_model: the tissue accepted no more requests
  const BladeCut& cut() const noexcept { return cut_; }

 private:
  double width_inside(const TissueView& tissue) const noexcept;
  bool order_cut(const Vector3& to, const TissueView& tissue, double least) noexcept;

  BladeCut cut_;
  Vector3 force_ = Vector3::Zero(), ordered_ = Vector3::Zero();
  Status status_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/servo_blade.ipp>
#endif
