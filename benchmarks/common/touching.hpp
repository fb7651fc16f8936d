// A sphere that slides over a body, with a given number of contacts.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <memory>
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
      : Touching(std::make_shared<Model>(body.mesh, body.scene(), tissue), 4e-3) {}
  /// A sphere of `radius` [m] on a model that several of these may share.
  Touching(std::shared_ptr<Model> model, double radius, const ServoOptions& options = {})
      : model_(std::move(model)), servo_(*model_, SphereTool{radius}, options), radius_(radius) {}

  /// Lowers the tool in steps [m] until the average number of pressing contacts over the circle is `contacts`.
  void press_until(int contacts, double step = 5e-6) {
    for (depth_ = step; depth_ < radius_; depth_ += step) {
      int sum = 0;
      for (int i = 0; i < ticks_around; ++i) {
        tick();
        sum += pressing();
      }
      if (sum >= (contacts - 0.25) * ticks_around) return;
    }
  }
  /// Lowers the tool to a depth [m] in 31 ticks.
  void press_to(double depth) noexcept {
    const double start = depth_;
    for (int i = 1; i <= ticks_around; ++i) {
      depth_ = start + (depth - start) * i / ticks_around;
      tick();
    }
  }
  double depth() const noexcept { return depth_; }
  /// From now on the tool moves on, or rests where it is.
  void slide(bool on) noexcept { step_ = on ? 1 : 0; }

  Vector3 tick() noexcept {
    const ToolState state = read();
    const GatedForce& force = servo_.tick(state);
    status_ |= force.status;
    return force.force();
  }
  int pressing() const noexcept { return static_cast<int>(servo_.tick_view().contacts().size()); }

  /// Keeps the tool fixed and measures, relative to the depth, the larger of two errors: the distance of the points
  /// that press from the sphere, and the difference between the displacement of their vertices by the stored compliance
  /// and that of the whole body under the same forces. The half-space between facets is not checked here: tests compare
  /// it with closed forms. Median of five positions: occasionally a contact on a rough surface takes long to settle.
  double gap_error() {
    std::vector<double> gaps;
    for (int i = 0; i < 5; ++i) gaps.push_back(settled_gap());
    return percentile(std::move(gaps), 0.5);
  }

  /// The flags since the last call.
  Status take_status() noexcept { return std::exchange(status_, {}); }
  const SetupReport& report() const noexcept { return model_->report(); }
  auto& servo() noexcept { return servo_; }

  // Interface of a haptic device.
  ToolState read() noexcept {
    const double angle = 2.0 * std::numbers::pi * (place_ % ticks_around) / ticks_around;
    place_ += step_;
    ToolState state;
    state.position << 0.23 * cell + orbit * std::cos(angle), 0.41 * cell + orbit * std::sin(angle), radius_ - depth_;
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
    const auto forces = servo_.read_snapshot().vertex_forces();
    VectorX u(3 * model_->mesh().node_count());
    model_->displacement_with(forces, u);
    double worst = pressing() > 0 ? 0.0 : infinity;
    for (const ToolContact& c : servo_.tick_view().contacts()) {
      worst = std::max(worst, std::abs((servo_.tick_view().proxy() - c.point).norm() - radius_));
      for (const int vertex : c.vertices) {
        Vector3 difference = u.segment<3>(3 * Index{model_->touchable_nodes()[static_cast<std::size_t>(vertex)]});
        for (const VertexForce& f : forces)
          difference -= model_->compliance(vertex, f.vertex) * f.force.in_model_axes();
        worst = std::max(worst, difference.norm());
      }
    }
    return worst / depth_;
  }

  static constexpr double orbit = 0.1e-3;
  static constexpr int ticks_around = 31;

  std::shared_ptr<Model> model_;
  HapticServo servo_;
  double radius_, depth_ = 0.0;
  int count_ = 0, place_ = 0, step_ = 1;
  Status status_;
};

/// Durations of ticks [s].
struct TickTimes {
  double p50 = 0.0, p99 = 0.0;
};
/// Wall times of single ticks with warm caches. Reading the processor time takes as long as a tick on some virtual
/// machines, and in a batch of ticks one interrupt would count for all of them.
inline TickTimes hot_ticks(Touching& body, int ticks = 20000) {
  for (int i = 0; i < 200; ++i) body.tick();
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) {
    const std::int64_t start = palpate::platform::wall_ns();
    body.tick();
    times.push_back(1e-9 * static_cast<double>(palpate::platform::wall_ns() - start));
  }
  return {percentile(times, 0.5), percentile(times, 0.99)};
}

}  // namespace bench
