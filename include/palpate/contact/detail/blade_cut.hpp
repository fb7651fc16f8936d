// Cutting resistance of a blade.
#pragma once

#include <palpate/contact/blade_tool.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The edge as a slider with a threshold: it stays in place until the coupling pulls with toughness times the length of
/// the edge in the tissue, and then advances under exactly that force. The work done is therefore toughness times the
/// area cut, up to rounding, and no motion of the hand gains energy (Griffith's balance for a sharp cut, as used for
/// haptics by Mahvash and Hayward 2001). The flanks have no friction and do not push the tissue aside. World frame.
class BladeCut {
 public:
  /// Throws bad_argument for an invalid blade, or for a stiffness [N/m] of the coupling between hand and edge that is
  /// not finite and positive.
  BladeCut(const BladeTool& tool, double stiffness);

  /// Moves the edge with the hand at `hand` [m]; `width` is the length of the edge in tissue [m]. Returns the force on
  /// the hand [N]. There is no resistance where this blade has cut before.
  Vector3 advance(const Vector3& hand, double width) noexcept;
  /// The next advance starts at the position of the hand.
  void lift() noexcept { known_ = false; }
  /// Back to the state after construction.
  void reset() noexcept;

  /// With a unit forward direction.
  const BladeTool& tool() const noexcept { return tool_; }
  /// Middle of the edge [m].
  const Vector3& edge() const noexcept { return edge_; }
  double area() const noexcept { return area_; }  ///< cut against resistance [m^2]
  double work() const noexcept { return work_; }  ///< work done by cutting [J]

 private:
  BladeTool tool_;
  double stiffness_;
  Vector3 edge_ = Vector3::Zero(), line_ = Vector3::Zero();
  double deepest_ = -infinity, area_ = 0.0, work_ = 0.0;
  bool known_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/blade_cut.ipp>
#endif
