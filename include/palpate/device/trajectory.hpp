// Scripted paths of a tool.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A path through timed waypoints. Between two it takes the minimum-jerk profile: smooth, at rest in every waypoint,
/// on the straight line. Before the first and after the last waypoint it stands still.
class Trajectory {
 public:
  struct Waypoint {
    double time;       ///< [s]
    Vector3 position;  ///< [m]
  };

  /// Throws SetupError(bad_argument) unless there is a waypoint, all are finite and their times increase.
  explicit Trajectory(std::vector<Waypoint> waypoints) : waypoints_(std::move(waypoints)) {
    if (waypoints_.empty()) raise(SetupErrorKind::bad_argument, "a trajectory without waypoints");
    for (std::size_t i = 0; i < waypoints_.size(); ++i) {
      const Waypoint& w = waypoints_[i];
      if (!std::isfinite(w.time) || !w.position.allFinite() || (i > 0 && !(w.time > waypoints_[i - 1].time)))
        raise(SetupErrorKind::bad_argument,
              "waypoint " + std::to_string(i) + " of a trajectory is not finite or not later: " + number(w.time) + " s",
              "Give finite waypoints in the order of time");
    }
  }

  /// Position [m] at time t [s]. Cost: a binary search.
  Vector3 operator()(double t) const noexcept {
    const Segment s = segment(t);
    return s.from + (s.to - s.from) * (s.u * s.u * s.u * (10.0 - s.u * (15.0 - 6.0 * s.u)));
  }
  /// Its derivative [m/s].
  Vector3 velocity(double t) const noexcept {
    const Segment s = segment(t);
    return (s.to - s.from) * (30.0 * s.u * s.u * (1.0 - s.u) * (1.0 - s.u) / s.duration);
  }
  double duration() const noexcept { return waypoints_.back().time; }  ///< [s] time of the last waypoint

 private:
  struct Segment {
    Vector3 from, to;
    double u, duration;  ///< 0 ... 1 along it; [s]
  };
  Segment segment(double t) const noexcept {
    const auto next = std::upper_bound(waypoints_.begin(), waypoints_.end(), t,
                                       [](double time, const Waypoint& w) { return time < w.time; });
    if (next == waypoints_.begin()) return {next->position, next->position, 0.0, 1.0};
    const Waypoint& from = *(next - 1);
    if (next == waypoints_.end()) return {from.position, from.position, 0.0, 1.0};
    const double duration = next->time - from.time;
    return {from.position, next->position, (t - from.time) / duration, duration};
  }

  std::vector<Waypoint> waypoints_;
};

/// Ready-made trajectories; positions in [m], times in [s]. All throw SetupError(bad_argument) as Trajectory does.
namespace trajectory {

struct Poke {
  Vector3 from = Vector3(0.0, 0.0, 0.02);
  Vector3 to = Vector3(0.0, 0.0, -0.01);
  double approach = 1.0, hold = 0.5, retreat = 1.0, pause = 0.5;
  int times = 1;
};
/// Goes from `from` to `to`, holds, goes back, pauses; `times` times.
inline Trajectory poke(const Poke& p = {}) {
  std::vector<Trajectory::Waypoint> path{{0.0, p.from}};
  const auto go = [&](double seconds, const Vector3& x) { path.push_back({path.back().time + seconds, x}); };
  for (int i = 0; i < p.times; ++i) {
    go(p.approach, p.to);
    go(p.hold, p.to);
    go(p.retreat, p.from);
    go(p.pause, p.from);
  }
  return Trajectory(std::move(path));
}

struct PressDragRelease {
  Vector3 above = Vector3(-0.01, 0.0, 0.02);     ///< where it starts
  Vector3 pressed = Vector3(-0.01, 0.0, -0.01);  ///< where it is pressed in
  Vector3 dragged = Vector3(0.01, 0.0, -0.01);   ///< where it is dragged to, and released as far as it was pressed
  double press = 1.0, drag = 2.0, release = 1.0;
};
/// Presses, drags along a line, releases.
inline Trajectory press_drag_release(const PressDragRelease& p = {}) {
  return Trajectory({{0.0, p.above},
                     {p.press, p.pressed},
                     {p.press + p.drag, p.dragged},
                     {p.press + p.drag + p.release, p.dragged + (p.above - p.pressed)}});
}

}  // namespace trajectory

}}  // namespace palpate
