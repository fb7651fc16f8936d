// Definitions of shared_tools.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/detail/shared_tools.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Forces and torques of the other tissues on a tool, world frame.
struct OtherLoads {
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  double largest = 0.0;  // of a force on the tool, also of the tissue itself [N]

  OtherLoads(std::span<const TouchedTissue> tissues, std::size_t own, std::size_t tool) noexcept {
    for (std::size_t k = 0; k < tissues.size(); ++k) {
      const ContactTool& contact = tissues[k].touch(tool).tool;
      if (!contact.active) continue;
      largest = std::max(largest, tissues[k].problem().scale_of_force(tool, contact.force.norm()));
      if (k == own) continue;
      force += tissues[k].force_on(tool);
      torque += tissues[k].torque_on(tool);
    }
  }
};

inline void set_shift(const OtherLoads& loads, Touch& touch) noexcept {
  const Vector3 rotation = touch.tool.rotational_compliance * loads.torque;
  touch.shift = touch.tool.compliance * loads.force;
  touch.rotation_change = rotation - touch.rotation;
  touch.rotation = rotation;
}

inline void begin_shared(std::span<TouchedTissue> tissues) noexcept {
  for (std::size_t k = 0; k < tissues.size(); ++k)
    for (Touch& touch : tissues[k].touches()) set_shift(OtherLoads(tissues, k, touch.number), touch);
}

inline ToolState moved_state(const ToolState& state, const Touch& touch) noexcept {
  ToolState s = state;
  s.position += touch.shift;
  if (!(touch.rotation.squaredNorm() > 0.0)) return s;
  const auto& [w, x, y, z] = state.orientation;
  const Quaternion<double> q = quaternion_by(touch.rotation) * Quaternion<double>{w, x, y, z};
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

/// How the forces of other tissues on the tools of the first one change from round to round, and what that extrapolates
/// to.
class Extrapolation {
 public:
  /// The factor of the next change, from that of the forces since they were used last, `change`.
  double factor(std::span<const Vector3> change) noexcept {
    double along = 0.0, squared = 0.0;
    for (std::size_t t = 0; t < change.size(); ++t) {
      const Vector3 difference = change[t] - before_[t];
      along += before_[t].dot(difference);
      squared += difference.squaredNorm();
      before_[t] = change[t];
    }
    if (std::exchange(known_, true) && squared > 0.0) factor_ = std::clamp(-factor_ * along / squared, least, most);
    return factor_;
  }
  /// The sum of all further changes, relative to the next one.
  double sum() const noexcept { return std::max(1.0, factor_); }

 private:
  static constexpr double least = 0.5, most = 20.0;
  std::array<Vector3, maximum_tools> before_{};
  double factor_ = 1.0;
  bool known_ = false;
};

/// Largest change of the forces of others on a tool since they were used, relative to the largest force on it. A tissue
/// without force counts where its target would move by a part of the radius: it takes the rest in the next tick.
inline double change_of_targets(std::span<const TouchedTissue> tissues, std::size_t own,
                                std::span<Vector3> changes) noexcept {
  constexpr double least_part = 0.05;
  double largest = 0.0;
  for (std::size_t t = 0; t < changes.size(); ++t) {
    const Touch& touch = tissues[own].touch(t);
    changes[t].setZero();
    if (!touch.tool.active) continue;
    const OtherLoads loads(tissues, own, t);
    const Vector3 path = touch.tool.compliance * loads.force - touch.shift;
    if (!(loads.largest > 0.0) || !(touch.tool.compliance > 0.0)) continue;
    if (touch.tool.force.squaredNorm() == 0.0 && !(path.norm() > least_part * touch.tool.radius)) continue;
    changes[t] = path / touch.tool.compliance;
    largest = std::max(largest, changes[t].norm() / loads.largest);
  }
  return largest;
}

inline void solve_shared(std::span<TouchedTissue> tissues, double tolerance) noexcept {
  constexpr double flagged = 0.05;
  constexpr int most_rounds = 12;
  std::array<Vector3, maximum_tools> room{};
  const std::span<Vector3> changes(room.data(), tissues.front().touches().size());
  for (TouchedTissue& tissue : tissues) tissue.begin();
  for (TouchedTissue& tissue : tissues) tissue.iterate();
  Extrapolation extrapolation;
  double left = infinity;
  std::size_t first = tissues.size();
  for (int round = 0; round < most_rounds && left > tolerance; ++round) {
    left = 0.0;
    for (std::size_t k = 0; k < tissues.size(); ++k) {
      const double change = change_of_targets(tissues, k, changes) * extrapolation.sum();
      left = std::max(left, change);
      if (!(change > tolerance)) continue;
      if (first == tissues.size()) first = k;
      const double factor = k == first ? extrapolation.factor(changes) : 1.0;
      for (Touch& touch : tissues[k].touches()) {
        const OtherLoads loads(tissues, k, touch.number);
        const Vector3 goal = touch.tool.compliance * loads.force;
        move_target(tissues[k], touch.shift + factor * (goal - touch.shift),
                    touch.rotation + factor * (touch.tool.rotational_compliance * loads.torque - touch.rotation),
                    touch);
      }
      tissues[k].iterate();
    }
  }
  for (TouchedTissue& tissue : tissues) {
    tissue.end();
    if (left > flagged) tissue.set_unsolved();
  }
}

PALPATE_INLINE const SharedTools& shared_tools() noexcept {
  static constexpr SharedTools functions{begin_shared, moved_state, solve_shared};
  return functions;
}

}}}  // namespace palpate::detail
