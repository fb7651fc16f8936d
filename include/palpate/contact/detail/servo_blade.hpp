// A blade as the servo has it.
#pragma once

#include <palpate/contact/blade_cut.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

class TissueView;

namespace detail {

/// Follows a hand with a blade and requests cuts along the surface swept by the edge. Everything runs in the tick: no
/// throw, no allocation, bounded. Made by TissueView::make_blade. Only the functions of a tissue that can be cut
/// (TissueFunctions) name the constructor, and only the constructor names what `follow` calls: a program without such a
/// tissue does not contain them. No virtual functions: g++ guesses the class and then contains its functions.
class ServoBlade {
 public:
  /// With a coupling of that stiffness [N/m]. Throws bad_argument as BladeCut does.
  ServoBlade(const BladeTool& tool, double stiffness);

  /// Moves with the hand, world frame [m]; `restart`: it starts there again, as if outside the tissue. Requests a cut
  /// along the swept surface once the path since the last request reaches the cut spacing.
  void follow(const Vector3& hand, bool restart, const TissueView& tissue) noexcept {
    follow_(*this, hand, restart, tissue);
  }
  /// The position of the hand is lost: no force.
  void lift() noexcept {
    cut_.lift();
    force_.setZero();
    status_ = {};
  }
  /// Back to the state after construction.
  void reset() noexcept;

  const Vector3& force() const noexcept { return force_; }  ///< on the hand, world frame [N]
  Status status() const noexcept { return status_; }        ///< degraded_model: the tissue accepted no more requests
  const BladeCut& cut() const noexcept { return cut_; }

 private:
  void advance(const Vector3& hand, bool restart, const TissueView& tissue) noexcept;
  double width_inside(const TissueView& tissue) const noexcept;
  bool order_cut(const Vector3& to, const TissueView& tissue, double least) noexcept;

  void (*follow_)(ServoBlade&, const Vector3&, bool, const TissueView&) noexcept;
  BladeCut cut_;
  Vector3 force_ = Vector3::Zero(), ordered_ = Vector3::Zero();
  Status status_;
};

/// Throws as the constructor of ServoBlade does. Allocates. Defined in servo_blade.ipp, which needs TissueView:
/// tissue_view.hpp includes it at its end.
std::unique_ptr<ServoBlade> make_blade(const BladeTool& tool, double stiffness);

}  // namespace detail

}}  // namespace palpate
