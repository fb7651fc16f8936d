// A blade in the hand: what it cuts, and how that feels.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

struct BladeParameters {
  Vector3 edge{0.0, 0.01, 0.0};     ///< from one end of the sharp edge to the other, world frame [m]
  Vector3 forward{0.0, 0.0, -1.0};  ///< where it is sharp; the blade goes back without resistance
  double toughness = 100.0;         ///< work per area of new slit [J/m^2]; soft tissues have some 50 to 500
  double stiffness = 400.0;         ///< of the coupling between hand and edge [N/m]
  double stroke = 1e-3;             ///< way of the edge after which the tissue is told [m]
};

/// The edge as a slider with a threshold: it holds until the coupling pulls with toughness times the length of the edge
/// in the tissue, and then goes on under just that force. So the work it takes is toughness times the area cut, to the
/// last digit, and no motion of the hand gains energy (Griffith's balance for a sharp cut, as Mahvash and Hayward 2001
/// use it for haptics). The flanks do not rub and do not push the tissue aside.
class BladeCut {
 public:
  /// Throws bad_argument for an edge or forward direction without length, or other values that are not positive.
  explicit BladeCut(const BladeParameters& parameters);

  /// Moves the edge with the hand at `hand` [m]; `width` of the edge is in tissue [m]. Returns the force on the hand
  /// [N]. Where this blade has been before, it goes free.
  Vector3 advance(const Vector3& hand, double width) noexcept;
  void lift() noexcept { known_ = false; }

  const BladeParameters& parameters() const noexcept { return parameters_; }
  /// Middle of the edge [m].
  const Vector3& edge() const noexcept { return edge_; }
  double area() const noexcept { return area_; }  ///< cut against resistance [m^2]
  double work() const noexcept { return work_; }  ///< that this took [J]

 private:
  BladeParameters parameters_;
  Vector3 edge_ = Vector3::Zero(), line_ = Vector3::Zero();
  double deepest_ = -infinity, area_ = 0.0, work_ = 0.0;
  bool known_ = false;
};

/// A session with a blade: the tick gives the resistance through a force gate and tells the tissue what is swept; the
/// tissue's thread cuts. Tissue is a CuttableTissue, or what has `stroke` and `begin_tick`. Neither copied nor moved.
template <class Tissue>
class BladeServo {
 public:
  /// Throws bad_argument as BladeCut and ForceGate do.
  BladeServo(Tissue& tissue, const BladeParameters& parameters, const ForceLimits& limits = {})
      : tissue_(&tissue), blade_(parameters), gate_(limits) {}
  BladeServo(const BladeServo&) = delete;
  BladeServo& operator=(const BladeServo&) = delete;

  /// One tick; no allocation, no lock, bounded.
  GatedForce tick(const ToolState& state) noexcept {
    const FlushDenormals flush;
    Status status = tissue_->begin_tick();
    const bool good = state.valid && all_finite(state.position) && std::isfinite(state.time);
    Vector3 force = Vector3::Zero();
    bool restart = false;
    if (good) {
      const bool jumped = told_known_ && (state.position - hand_).norm() > blade_.parameters().edge.norm();
      if (jumped || !told_known_) {
        restart = true;
        blade_.lift();
      }
      hand_ = state.position;
      force = blade_.advance(hand_, restart ? 0.0 : width_inside());
      if (restart) told_ = blade_.edge();
      told_known_ = true;
      if (!tell()) status.set(StatusFlag::degraded_model);
    } else {
      if (state.valid) status.set(StatusFlag::non_finite_input);
      told_known_ = false;
    }
    GatedForce out = gate_.apply(force, state.time, state.time, good, restart);
    out.status |= status;
    return out;
  }
  const BladeCut& blade() const noexcept { return blade_; }

 private:
  static constexpr int samples = 8;  // along the edge

  double width_inside() const noexcept {
    const Vector3& edge = blade_.parameters().edge;
    int inside = 0;
    for (int k = 0; k < samples; ++k) {
      const Vector3 x = blade_.edge() + ((k + 0.5) / samples - 0.5) * edge;
      if (tissue_->contact_surface().closest(inverse(tissue_->to_world()) * x).distance < 0.0) ++inside;
    }
    return edge.norm() * inside / samples;
  }
  /// Tells the tissue what was swept since it was told last; false when it cannot take it yet.
  bool tell() noexcept {
    const Vector3 way = blade_.edge() - told_;
    if (way.dot(blade_.parameters().forward) < 0.0) told_ = blade_.edge();  // back through the slit
    if (way.norm() < blade_.parameters().stroke) return true;
    const Vector3 half = 0.5 * blade_.parameters().edge;
    if (!tissue_->stroke({told_ - half, told_ + half, blade_.edge() - half, blade_.edge() + half})) return false;
    told_ = blade_.edge();
    return true;
  }

  Tissue* tissue_;
  BladeCut blade_;
  ForceGate gate_;
  Vector3 hand_ = Vector3::Zero(), told_ = Vector3::Zero();
  bool told_known_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/blade.ipp>
#endif
