// Definitions of trajectory.hpp.
#pragma once

#include <palpate/device/trajectory.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Trajectory::Trajectory(std::vector<Waypoint> waypoints) : waypoints_(std::move(waypoints)) {
  if (waypoints_.empty()) raise(SetupErrorKind::bad_argument, "a trajectory has no waypoints");
  for (std::size_t i = 0; i < waypoints_.size(); ++i) {
    const Waypoint& w = waypoints_[i];
    if (!std::isfinite(w.time) || !w.position.allFinite() || (i > 0 && !(w.time > waypoints_[i - 1].time)))
      raise(SetupErrorKind::bad_argument,
            "waypoint " + std::to_string(i) + " of a trajectory is not finite or not later: " + number(w.time) + " s",
            "Give finite waypoints in order of increasing time");
  }
}

PALPATE_INLINE Vector3 Trajectory::operator()(double t) const noexcept {
  const Segment s = segment(t);
  return s.from + (s.to - s.from) * (s.u * s.u * s.u * (10.0 - s.u * (15.0 - 6.0 * s.u)));
}

PALPATE_INLINE Vector3 Trajectory::velocity(double t) const noexcept {
  const Segment s = segment(t);
  return (s.to - s.from) * (30.0 * s.u * s.u * (1.0 - s.u) * (1.0 - s.u) / s.duration);
}

PALPATE_INLINE Trajectory::Segment Trajectory::segment(double t) const noexcept {
  const auto next = std::upper_bound(waypoints_.begin(), waypoints_.end(), t,
                                     [](double time, const Waypoint& w) { return time < w.time; });
  if (next == waypoints_.begin()) return {next->position, next->position, 0.0, 1.0};
  const Waypoint& from = *(next - 1);
  if (next == waypoints_.end()) return {from.position, from.position, 0.0, 1.0};
  const double duration = next->time - from.time;
  return {from.position, next->position, (t - from.time) / duration, duration};
}

}}  // namespace palpate

namespace palpate { inline namespace PALPATE_ABI { namespace trajectory {

PALPATE_INLINE Trajectory poke(const Poke& p) {
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

}}}  // namespace palpate::trajectory
