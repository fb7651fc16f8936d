// Slides without friction: ripple and side force, and the force after a closed path.
#include "presses.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace presses {
namespace {

struct Slide {
  double ripple, side, closed;  ///< relative to the force
};

/// A sphere pressed to `depth`, moved along a closed path, with forces that have settled.
class Sphere {
 public:
  Sphere(Tissue& tissue, double radius, const Vector3& at) : servo_(tissue, SphereTool{radius}, options()), at_(at) {}

  /// Calls `note` with every force.
  template <class Note>
  void move(const Vector3& by, double step, Note&& note) {
    const Vector3 from = at_;
    const int ticks = static_cast<int>(std::ceil(by.norm() / step));
    for (int k = 1; k <= ticks; ++k) {
      at_ = from + by * k / ticks;
      note(tick());
    }
  }
  Vector3 settle() {
    for (int k = 0; k < 100; ++k) tick();
    return servo_.tick_view().contact_force();
  }

 private:
  static ServoOptions options() {
    ServoOptions options;
    options.coupling_stiffness = infinity;
    options.force_limits = open_gate();
    return options;
  }
  Vector3 tick() {
    ToolState state;
    state.position = at_;
    state.time = 1e-3 * ++ticks_;
    servo_.tick(state);
    return servo_.tick_view().contact_force();
  }

  HapticServo servo_;
  Vector3 at_;
  int ticks_ = 0;
};

/// What is left of forces along a path without their trend, a parabola: that of a block whose sides are near.
Eigen::MatrixX3d without_trend(const std::vector<Vector3>& forces) {
  const auto count = static_cast<Eigen::Index>(forces.size());
  Eigen::MatrixX3d powers(count, 3), values(count, 3);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(count);
    powers.row(k) << 1.0, t, t * t;
    values.row(k) = forces[static_cast<std::size_t>(k)].transpose();
  }
  return values - powers * powers.colPivHouseholderQr().solve(values);
}

/// In, along, on to another depth, back, and up again: the force is that of before.
Slide slide(Tissue& tissue, double top, double radius, double depth, const Vector3& place, double direction) {
  const Vector3 along(20e-3 * std::cos(direction), 20e-3 * std::sin(direction), 0.0), up(0.0, 0.0, 1e-3 + depth);
  const auto ignore = [](const Vector3&) {};
  Sphere sphere(tissue, radius, place + (top + radius + 1e-3) * Vector3::UnitZ());
  sphere.move(-up, 5e-5, ignore);
  const Vector3 before = sphere.settle();
  std::vector<Vector3> forces;
  sphere.move(along, 5e-5, [&](const Vector3& f) { forces.push_back(f); });
  sphere.move(Vector3(0.0, 0.0, -depth), 5e-5, ignore);  // twice as deep: other points
  sphere.move(-along, 5e-5, ignore);
  sphere.move(Vector3(0.0, 0.0, depth), 5e-5, ignore);
  const Vector3 after = sphere.settle();
  const Eigen::MatrixX3d rest = without_trend(forces);
  const double per_force = 1.0 / before.norm(), count = static_cast<double>(forces.size());
  return {std::sqrt(rest.col(2).squaredNorm() / count) * per_force,
          std::sqrt(rest.leftCols<2>().squaredNorm() / count) * per_force, (after - before).norm() * per_force};
}

}  // namespace

bool slides(int runs) {
  constexpr double top = 0.04;
  testing::Random random(11);
  std::printf(
      "\nslides of 20 mm without friction: ripple and side force (root of mean square), change of the force by a "
      "closed\n"
      "path over twice the depth, the most of %d places [%%]\n",
      runs);
  std::printf("%10s %8s %8s %8s %8s %8s\n", "facets", "radius", "depth/R", "ripple", "side", "closed");
  bool right = true;
  for (const int cells : {24, 12, 6}) {
    Tissue tissue = block({0.06, 0.06, top}, {cells, cells, cells * 2 / 3});
    for (const double radius : {4e-3, 8e-3})
      for (const double part : {1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0}) {
        Slide worst{0.0, 0.0, 0.0};
        for (int k = 0; k < runs; ++k) {
          const Vector3 place(random.uniform(0.025, 0.035), random.uniform(0.025, 0.035), 0.0);
          const double direction = random.uniform(0.0, 6.28);
          const Vector3 start = place - 10e-3 * Vector3(std::cos(direction), std::sin(direction), 0.0);
          const Slide s = slide(tissue, top, radius, part * radius, start, direction);
          worst = {larger(worst.ripple, s.ripple), larger(worst.side, s.side), larger(worst.closed, s.closed)};
        }
        std::printf("%7.1f mm %5.0f mm %8.4f %8.2f %8.2f %8.2f\n", 60.0 / cells, 1e3 * radius, part,
                    100.0 * worst.ripple, 100.0 * worst.side, 100.0 * worst.closed);
        std::fflush(stdout);
        right = right && worst.ripple < 0.02 && worst.side < 0.01;
      }
  }
  return right;
}

}  // namespace presses
