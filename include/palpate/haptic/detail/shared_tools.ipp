// Definitions of shared_tools.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/detail/shared_tools.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Forces and torques of the other tissues on a tool, world frame, and by which they move its target.
struct OtherLoads {
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  double largest = 0.0;  // of a force on the tool, also of the tissue itself [N]

  OtherLoads(std::span<const TouchedTissue> tissues, std::size_t own, std::size_t tool) noexcept {
    for (std::size_t k = 0; k < tissues.size(); ++k) {
      const Touch& touch = tissues[k].touch(tool);
      if (!touch.presses()) continue;
      largest = std::max(largest, tissues[k].problem().scale_of_force(tool, touch.tool.force.norm()));
      if (k == own) continue;
      force += tissues[k].force_on(tool);
      torque += tissues[k].torque_on(tool);
    }
  }
  Vector3 shift(const Touch& touch) const noexcept { return touch.tool.compliance * force; }
  Vector3 rotation(const Touch& touch) const noexcept {
    return (touch.input.rotates() ? touch.tool.rotational_compliance : 0.0) * torque;
  }
};

/// A state that the tissue will refuse moves nothing: its target stays where the last one put it.
inline ToolState moved_state(std::span<TouchedTissue> tissues, std::size_t own, std::size_t tool,
                             const ToolState& state) noexcept {
  Touch& touch = tissues[own].touch(tool);
  touch.rotation_change.setZero();
  if (!touch.input.would_accept(state)) return state;
  const OtherLoads loads(tissues, own, tool);
  const Vector3 rotation = loads.rotation(touch);
  touch.shift = loads.shift(touch);
  touch.rotation_change = rotation - touch.rotation;
  touch.rotation = rotation;
  ToolState s = state;
  s.position += touch.shift;
  if (!(rotation.squaredNorm() > 0.0)) return s;
  const auto& [w, x, y, z] = state.orientation;
  const Quaternion<double> q = quaternion_by(rotation) * Quaternion<double>{w, x, y, z};
  s.orientation = {q.w, q.x, q.y, q.z};
  return s;
}

/// Moves the target of a tool within a tick.
inline void move_target(const TouchedTissue& tissue, const Vector3& shift, const Vector3& rotation,
                        Touch& touch) noexcept {
  const Matrix3 to_model = palpate::rotation_of(tissue.view().to_world()).transpose();
  const Vector3 path = to_model * (shift - touch.shift);
  touch.tool.target += path;
  touch.input.move(path);
  if ((rotation - touch.rotation).squaredNorm() > 0.0)
    touch.tool.target_rotation = rotation_by(to_model * (rotation - touch.rotation)) * touch.tool.target_rotation;
  touch.shift = shift;
  touch.rotation = rotation;
}

/// How far the targets of a tissue are from where the forces of the others put them.
struct TargetChange {
  std::array<Vector3, 2 * maximum_tools> forces{};  // of the couplings, and torques divided by an arm [N]
  double relative = 0.0;                            // the largest, relative to the largest force on its tool
};

/// A tissue without force on a tool counts where its target would move by a part of the radius: it takes the rest in
/// the next tick.
inline TargetChange change_of_targets(std::span<const TouchedTissue> tissues, std::size_t own) noexcept {
  constexpr double least_part = 0.05;
  TargetChange change;
  for (std::size_t t = 0; t < tissues[own].touches().size(); ++t) {
    const Touch& touch = tissues[own].touch(t);
    Vector3 &force = change.forces[2 * t], &torque = change.forces[2 * t + 1];
    force.setZero();
    torque.setZero();
    if (!touch.tool.active) continue;
    const OtherLoads loads(tissues, own, t);
    const Vector3 path = loads.shift(touch) - touch.shift, angle = loads.rotation(touch) - touch.rotation;
    const double arm = std::max(touch.tool.half_length, touch.tool.radius);
    if (!touch.presses() && !(path.norm() + arm * angle.norm() > least_part * touch.tool.radius)) continue;
    if (touch.tool.compliance > 0.0) force = path / touch.tool.compliance;
    if (touch.tool.rotational_compliance > 0.0) torque = angle / (touch.tool.rotational_compliance * arm);
    const double largest = std::max(force.norm(), torque.norm());
    if (largest > 0.0) change.relative = std::max(change.relative, loads.largest > 0.0 ? largest / loads.largest : 1.0);
  }
  return change;
}

/// How the forces of other tissues on the tools of one change from round to round, and what that extrapolates to.
class Extrapolation {
 public:
  /// The factor of the next change, from that of the forces since they were used last.
  double factor(const TargetChange& change) noexcept {
    double along = 0.0, squared = 0.0;
    for (std::size_t i = 0; i < change.forces.size(); ++i) {
      const Vector3 difference = change.forces[i] - before_.forces[i];
      along += before_.forces[i].dot(difference);
      squared += difference.squaredNorm();
    }
    before_ = change;
    if (std::exchange(known_, true) && squared > 0.0) factor_ = std::clamp(-factor_ * along / squared, least, most);
    return factor_;
  }
  /// The sum of all further changes, relative to the next one.
  double sum() const noexcept { return std::max(1.0, factor_); }

 private:
  static constexpr double least = 0.5, most = 20.0;
  TargetChange before_;
  double factor_ = 1.0;
  bool known_ = false;
};

inline void solve_shared(std::span<TouchedTissue> tissues, double tolerance) noexcept {
  constexpr double flagged = 0.05;
  constexpr double small_rest =
      5.0;  // tolerances that may be left: where changes hardly fall, less would take all rounds
  constexpr int most_rounds = 5, linearisations = 2;
  for (TouchedTissue& tissue : tissues) tissue.begin();
  for (TouchedTissue& tissue : tissues) tissue.iterate();
  Extrapolation extrapolation;
  double left = infinity, rest = infinity;
  std::size_t first = tissues.size();  // the tissue whose changes are extrapolated
  for (int round = 0; round < most_rounds && left > tolerance; ++round) {
    left = rest = 0.0;
    for (std::size_t k = 0; k < tissues.size(); ++k) {
      const TargetChange change = change_of_targets(tissues, k);
      const double all_changes = change.relative * extrapolation.sum();
      const double expected = std::max(change.relative, all_changes / small_rest);
      left = std::max(left, expected);
      rest = std::max(rest, all_changes);
      if (!(expected > tolerance)) continue;
      if (first == tissues.size()) first = k;
      const double factor = k == first ? extrapolation.factor(change) : 1.0;
      for (Touch& touch : tissues[k].touches()) {
        const OtherLoads loads(tissues, k, touch.number);
        move_target(tissues[k], touch.shift + factor * (loads.shift(touch) - touch.shift),
                    touch.rotation + factor * (loads.rotation(touch) - touch.rotation), touch);
      }
      tissues[k].iterate(linearisations);
    }
  }
  for (TouchedTissue& tissue : tissues) {
    tissue.end();
    if (rest > flagged) tissue.set_unsolved();
  }
}

PALPATE_INLINE const SharedTools& shared_tools() noexcept {
  static constexpr SharedTools functions{moved_state, solve_shared};
  return functions;
}

}}}  // namespace palpate::detail
