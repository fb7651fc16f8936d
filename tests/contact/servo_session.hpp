// Models and sessions shared by the servo's tests.
#pragma once

#include "contact/analytic_tissue.hpp"

#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <cmath>

namespace test {

using Pad = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

inline constexpr double pad_height = 0.02;
inline constexpr double sphere_radius = 4e-3;

/// A block of 30 x 30 x 20 mm, fixed below; its top, or all of its surface, can be touched. Columns are computed in the
/// tick by default.
template <class Model = Pad>
Model make_pad(const char* touched = "z1", double youngs_modulus = 1e4, std::array<int, 3> cells = {6, 6, 4},
               const SetupOptions& options = {.columns = ColumnFill::synchronous}) {
  Scene scene;
  scene.fix("z0").touch(touched);
  return Model(box_tet4(Vector3(0.03, 0.03, pad_height), cells, BoxSplit::six), scene,
               LinearElastic{.youngs_modulus = youngs_modulus, .poisson_ratio = 0.3}, options);
}

/// The block with all of its surface touchable; constructed once.
inline Pad& whole_pad() {
  static Pad pad = make_pad("surface");
  return pad;
}

/// Limits that let every force pass.
inline ForceLimits open_gate() {
  ForceLimits limits;
  limits.peak_force = 1e3;
  limits.slew_rate = 1e9;
  limits.ramp_time = 1e-9;
  return limits;
}

/// A servo, its tools and a 1 kHz clock.
template <class Model>
struct ServoSession {
  HapticServo servo;
  std::vector<ToolState> states;
  std::vector<GatedForce> forces;
  double period = 1e-3;

  explicit ServoSession(Model& model, const ServoOptions& options = {}, std::size_t tools = 1)
      : servo(model, std::vector<SphereTool>(tools, SphereTool{.radius = sphere_radius}), options), states(tools) {}

  /// One tick with the present states, one period later.
  const GatedForce& tick() {
    for (ToolState& s : states) s.time += period;
    const std::span<const GatedForce> got = servo.tick(states);
    forces.assign(got.begin(), got.end());
    return forces.front();
  }
  const GatedForce& tick(const Vector3& position) {
    states.front().position = position;
    return tick();
  }
  /// In `ticks` equal steps.
  const GatedForce& move(const Vector3& to, int ticks) {
    const Vector3 from = states.front().position;
    for (int i = 1; i <= ticks; ++i) tick(from + (to - from) * i / ticks);
    return forces.front();
  }
  const GatedForce& hold(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
    return forces.front();
  }
  /// From the air straight down until the sphere would overlap the undeformed tissue by `depth`.
  const GatedForce& press(double depth, double x = 0.0137, double y = 0.0159) {
    tick(Vector3(x, y, pad_height + sphere_radius + 1e-3));
    return move(Vector3(x, y, pad_height + sphere_radius - depth), 100);
  }
};

/// Work of the force on a tool along its path.
struct PathWork {
  double gained = 0.0, exchanged = 0.0;  ///< sum of the work of all ticks, and of its magnitudes [J]

  void add(const Vector3& position, const Vector3& force) {
    if (started_) {
      const double work = 0.5 * (force_ + force).dot(position - position_);
      gained += work;
      exchanged += std::abs(work);
    }
    position_ = position;
    force_ = force;
    started_ = true;
  }

 private:
  Vector3 position_ = Vector3::Zero(), force_ = Vector3::Zero();
  bool started_ = false;
};

/// Whether two vectors are bitwise equal.
inline bool same(const Vector3& a, const Vector3& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace test
