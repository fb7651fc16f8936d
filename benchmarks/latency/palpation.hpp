// A sphere that slides over a block with a given number of contacts.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <numbers>

#include "block.hpp"
#include "sampling.hpp"

namespace latency {

/// A model, a servo with default options, and a simulated hand that moves on a small circle, 20 um per tick, away from
/// nodes and edges.
template <class Policy>
class Palpation {
 public:
  using Model = palpate::HapticFEModel<palpate::Tet4, palpate::LinearElastic, Policy>;

  explicit Palpation(const Block& block,
                     const palpate::SetupOptions& options = {.columns = palpate::ColumnFill::synchronous})
      : mesh_(make_mesh(block)),
        model_(mesh_, make_scene(mesh_, block), tissue, options),
        servo_(model_, palpate::SphereTool{radius}) {}

  Model& model() noexcept { return model_; }

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
  /// Moves to a depth; path and start are the same for every policy.
  void press_to(double depth) {
    depth_ = depth;
    for (int i = 0; i < ticks_around; ++i) tick();
  }
  double depth() const noexcept { return depth_; }

  palpate::Vector3 tick() noexcept {
    const double angle = 2.0 * std::numbers::pi * (count_ % ticks_around) / ticks_around;
    state_.position << 0.23 * cell + orbit * std::cos(angle), 0.41 * cell + orbit * std::sin(angle),
        height + radius - depth_;
    return hold();
  }
  palpate::Vector3 hold() noexcept {
    state_.time = 1e-3 * static_cast<double>(++count_);
    return servo_.tick({&state_, 1}).front().force();
  }
  palpate::Vector3 contact_force() const noexcept { return servo_.tick_view().contact_force(); }
  int pressing() const noexcept { return static_cast<int>(servo_.tick_view().contacts().size()); }

  /// Keeps the tool fixed, applies the forces to the whole body and measures the distance of the pressed points from
  /// the sphere, relative to the depth. Does not use the stored compliance.
  double gap_error() {
    for (int i = 0; i < 50; ++i) hold();
    palpate::VectorX u(3 * model_.mesh().node_count());
    model_.displacement_with(servo_.read_snapshot().vertex_forces(), u);
    double worst = pressing() > 0 ? 0.0 : palpate::infinity;
    for (const palpate::ToolContact& c : servo_.tick_view().contacts()) {
      palpate::Vector3 point = palpate::Vector3::Zero();
      for (std::size_t a = 0; a < 3; ++a) {
        const palpate::NodeId node = model_.touchable_nodes()[static_cast<std::size_t>(c.vertices[a])];
        point += c.weights[a] * (model_.rest_position(node) + u.segment<3>(3 * palpate::Index{node}));
      }
      worst = std::max(worst, std::abs((servo_.tick_view().proxy() - point).norm() - radius));
    }
    return worst / depth_;
  }

  /// Adds the sizes of the problem to the reported counters.
  void describe(benchmark::State& state) const {
    const palpate::SetupReport& r = model_.report();
    state.counters["tets"] = static_cast<double>(r.elements);
    state.counters["kept"] = static_cast<double>(r.touchable_vertices);
    state.counters["contacts"] = pressing();
    state.counters["points"] = servo_.tick_view().contact_rows();
    state.counters["setup_ms"] = 1e3 * r.total_seconds();
  }

 private:
  static constexpr double radius = 4e-3, orbit = 0.1e-3;
  static constexpr int ticks_around = 31;

  palpate::Mesh<palpate::Tet4> mesh_;
  Model model_;
  palpate::HapticServo servo_;
  palpate::ToolState state_;
  double depth_ = 0.0;
  int count_ = 0;
};

}  // namespace latency
