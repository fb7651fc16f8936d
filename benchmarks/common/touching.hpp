// A sphere that slides over a body, with a given number of contacts.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <numbers>

#include "bodies.hpp"
#include "timing.hpp"

namespace bench {

inline constexpr double cell = 1e-3;  ///< element size of the bodies that are touched [m]

/// Block of 1 mm cells, across x across x deep. Touchable are 17 x 17 nodes in the middle of its top, the same in every
/// block. `across` is even and at least 16.
inline SupportedBody touch_block(int across, int deep) {
  const Vector3 size(cell * across, cell * across, cell * deep);
  SupportedBody b{box_tet4(size, {across, across, deep}, BoxSplit::six), {}, {}};
  for (Vector3& p : b.mesh.positions) p -= Vector3(0.5 * size.x(), 0.5 * size.y(), size.z());
  b.constrained = nodes_where(b.mesh, [&](const Vector3& p) { return p.z() < 1e-6 * cell - size.z(); });
  b.touched = nodes_where(
      b.mesh, [](const Vector3& p) { return p.z() > -1e-6 * cell && p.head<2>().cwiseAbs().maxCoeff() < 8.1 * cell; });
  return b;
}
/// An organ-like body of 1 mm elements, with its top at the origin.
inline SupportedBody touch_organ(int layers) {
  SupportedBody b = organ_like(layers, cell);
  for (Vector3& p : b.mesh.positions) p.z() -= layers * cell;
  return b;
}

/// A model, a servo with default options, and a simulated hand that moves on a small circle about the origin, 20 um per
/// tick. It is also a haptic device.
class Touching {
 public:
  using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

  explicit Touching(const SupportedBody& body)
      : model_(body.mesh, body.scene(), tissue), servo_(model_, SphereTool{radius}) {}

  /// Lowers the tool until the average number of pressing contacts over the circle is `contacts`.
  void press_until(int contacts) {
    for (depth_ = 5e-6; depth_ < radius; depth_ += 5e-6) {
      int sum = 0;
      for (int i = 0; i < ticks_around; ++i) {
        tick();
        sum += pressing();
      }
      if (sum >= (contacts - 0.25) * ticks_around) return;
    }
  }

  Vector3 tick() noexcept {
    const ToolState state = read();
    return servo_.tick({&state, 1}).front().force();
  }
  int pressing() const noexcept { return static_cast<int>(servo_.contacts().size()); }

  /// Keeps the tool fixed, applies the forces to the whole body and measures the distance of the pressed points from
  /// the sphere, relative to the depth. Does not use the stored compliance. Median of five positions: occasionally a
  /// contact on a rough surface takes long to settle.
  double gap_error() {
    std::vector<double> gaps;
    for (int i = 0; i < 5; ++i) gaps.push_back(settled_gap());
    return percentile(std::move(gaps), 0.5);
  }

  const SetupReport& report() const noexcept { return model_.report(); }
  auto& servo() noexcept { return servo_; }

  // Interface of a haptic device.
  ToolState read() noexcept {
    const double angle = 2.0 * std::numbers::pi * (count_ % ticks_around) / ticks_around;
    ToolState state;
    state.position << 0.23 * cell + orbit * std::cos(angle), 0.41 * cell + orbit * std::sin(angle), radius - depth_;
    state.time = 1e-3 * static_cast<double>(++count_);
    return state;
  }
  Status write(const GatedForce&) noexcept { return {}; }
  DeviceLimits limits() const noexcept { return {}; }
  void start() {}
  void stop() noexcept {}

 private:
  double settled_gap() {
    ToolState state = read();
    for (int i = 0; i < 50; ++i, state.time += 1e-3) servo_.tick({&state, 1});
    VectorX u(3 * model_.mesh().node_count());
    model_.displacement_with(servo_.read_snapshot().vertex_forces(), u);
    double worst = pressing() > 0 ? 0.0 : infinity;
    for (const ToolContact& c : servo_.contacts()) {
      Vector3 point = Vector3::Zero();
      for (std::size_t a = 0; a < 3; ++a) {
        const NodeId node = model_.touchable_nodes()[static_cast<std::size_t>(c.vertices[a])];
        point += c.weights[a] * (model_.rest_position(node) + u.segment<3>(3 * Index{node}));
      }
      worst = std::max(worst, std::abs((servo_.proxy() - point).norm() - radius));
    }
    return worst / depth_;
  }

  static constexpr double radius = 4e-3, orbit = 0.1e-3;
  static constexpr int ticks_around = 31;

  Model model_;
  HapticServo servo_;
  double depth_ = 0.0;
  int count_ = 0;
};

/// Durations of ticks [s].
struct TickTimes {
  double p50 = 0.0, p99 = 0.0;
};
/// Times of ticks with warm caches, eight ticks between two readings of the clock: a reading costs as much as a tick.
inline TickTimes hot_ticks(Touching& body, int batches = 2500) {
  for (int i = 0; i < 200; ++i) body.tick();
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(batches));
  for (int i = 0; i < batches; ++i) {
    const std::int64_t start = palpate::platform::compute_ns();
    for (int k = 0; k < 8; ++k) body.tick();
    times.push_back(1e-9 / 8.0 * static_cast<double>(palpate::platform::compute_ns() - start));
  }
  return {percentile(times, 0.5), percentile(times, 0.99)};
}

}  // namespace bench
