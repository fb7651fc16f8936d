// Measures the energy that a session has given to the hand.
#pragma once

#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Passivity observer (Hannaford and Ryu, IEEE T-RA 18(1), 2002): the work of the forces on the tool from sampled
/// positions, f(n-1) . (x(n) - x(n-1)), with the force that acted in between. Steps that are not finite, or would
/// make the sum infinite, are ignored.
class PassivityObserver {
 public:
  /// `delay` in whole ticks, 0 to 32.
  explicit PassivityObserver(int delay = 0) noexcept;

  /// One interval between two samples.
  struct Step {
    double work = 0.0;          ///< [J] given to the tool
    double squared_path = 0.0;  ///< [m^2] square of the displacement
    double time = 0.0;          ///< [s] > 0, or 0 when the time stamps give no duration
  };

  /// Processes a new sample.
  Step moved(const Vector3& position, double time) noexcept;
  /// Adds other work, that of a torque.
  void moved_by(double work) noexcept;
  /// Records the force that was rendered in response to that sample.
  void gave(const Vector3& force) noexcept;
  /// The displacement to the next sample is ignored: the device was lost, or the tool jumped.
  void forget() noexcept { known_ = false; }

  /// [J] given to the tool since construction; below zero: taken from it. Always finite.
  double given() const noexcept { return given_; }
  /// [N] the force that acts until the next sample.
  const Vector3& acting() const noexcept;

 private:
  void add(double work) noexcept;

  std::array<Vector3, 33> forces_;
  std::size_t delay_, newest_ = 0;
  Vector3 last_ = Vector3::Zero();
  double last_time_ = 0.0, given_ = 0.0;
  bool known_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/passivity_observer.ipp>
#endif
