// Scripted paths of a tool.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A path through timed waypoints. Between two waypoints it has the minimum-jerk profile: smooth, on the straight line,
/// with zero velocity at every waypoint. Before the first and after the last waypoint it stands still.
class Trajectory {
 public:
  struct Waypoint {
    double time;       ///< [s]
    Vector3 position;  ///< [m]
  };

  /// Throws SetupError(bad_argument) unless there is a waypoint, all are finite and their times increase.
  explicit Trajectory(std::vector<Waypoint> waypoints);

  /// Position [m] at time t [s]. Cost: a binary search.
  Vector3 operator()(double t) const noexcept;
  /// Its derivative [m/s].
  Vector3 velocity(double t) const noexcept;
  double duration() const noexcept { return waypoints_.back().time; }  ///< [s] time of the last waypoint

 private:
  struct Segment {
    Vector3 from, to;
    double u, duration;  ///< 0 ... 1 along it; [s]
  };
  Segment segment(double t) const noexcept;

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
/// Moves from `from` to `to`, waits, moves back, pauses; `times` times.
Trajectory poke(const Poke& p = {});

}  // namespace trajectory

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/trajectory.ipp>
#endif
