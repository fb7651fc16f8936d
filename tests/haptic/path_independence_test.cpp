// The force of a frictionless tool depends on where it is, not on how it came there: all points that it would enter
// have a row, also those between vertices that the mesh shows too deep.
#include <palpate/element/wrappers.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <cmath>

using namespace palpate;

namespace {

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
constexpr double top = 0.02, radius = 8e-3, depth = radius / 16.0;

/// A sphere that is moved in small steps, with forces that have converged.
class Sphere {
 public:
  explicit Sphere(Organ& organ) : servo_(organ, SphereTool{.radius = radius}, options()) {}

  void move(const Vector3& goal, int ticks) {
    const Vector3 from = at_;
    for (int i = 1; i <= ticks; ++i) {
      const Vector3 step = (goal - from) / ticks, before = force_;
      at_ = from + i * step;
      ToolState state;
      state.position = at_;
      state.time = 1e-3 * ++ticks_;
      servo_.tick(state);
      force_ = servo_.tick_view().contact_force();
      work_ -= 0.5 * (before + force_).dot(step);
    }
  }
  void press(const Vector3& place) {
    servo_.reset();
    at_ = place + (top + radius) * Vector3::UnitZ();
    force_.setZero();
    move(at_ - depth * Vector3::UnitZ(), 100);
    move(at_, 20);
  }
  const Vector3& at() const { return at_; }
  const Vector3& force() const { return force_; }
  double work() const { return work_; }  ///< done by the hand [J]

 private:
  static ServoOptions options() {
    ServoOptions options;
    options.coupling_stiffness = infinity;
    options.force_limits = test::open_gate();
    options.contact.force_tolerance = 1e-6;
    options.contact.maximum_iterations = 20;
    return options;
  }

  HapticServo servo_;
  Vector3 at_ = Vector3::Zero(), force_ = Vector3::Zero();
  double work_ = 0.0;
  int ticks_ = 0;
};

}  // namespace

TEST_CASE("the force of a slide is that of a press at the same place, and its work is the change of energy",
          "[haptic][contact]") {
  Scene scene;
  scene.fix("z0").touch("z1");
  Organ organ(box_tet4(Vector3(0.06, 0.06, top), {24, 24, 8}, BoxSplit::six), scene, {5e3, 0.45, 1060.0});
  Sphere sliding(organ), pressing(organ);
  const Vector3 start(0.0205, 0.0231, 0.0), path(0.018, 0.0133, 0.0);
  sliding.press(start);
  const double press = sliding.work();
  for (int k = 1; k <= 10; ++k) {
    const Vector3 place = start + 0.1 * k * path;
    sliding.move(place + (top + radius - depth) * Vector3::UnitZ(), 100);
    pressing.press(place);
    CAPTURE(k, sliding.force(), pressing.force());
    CHECK((sliding.force() - pressing.force()).norm() < 1e-4 * pressing.force().norm());
  }
  sliding.move(sliding.at() + depth * Vector3::UnitZ(), 100);
  CHECK(std::abs(sliding.work()) < 2e-3 * press);
}
