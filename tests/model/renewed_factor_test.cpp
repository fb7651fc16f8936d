// A factor renewed by a background thread changes the speed of a step, never its result.
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/detail/corotated_motion.hpp>
#include <palpate/model/moving/renewed_factor.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <chrono>
#include <thread>

#include "catch.hpp"

using namespace palpate;

namespace {

using Renewed = detail::CorotatedMotion<double, RenewedFactor>;
using Rotated = detail::CorotatedMotion<double, CorotatedFactor>;

HyperelasticBody<Tet4, Corotational> column() {
  return make_hyperelastic_body(box_tet4({0.02, 0.02, 0.08}, {2, 2, 8}), std::vector<Corotational>{{5e3, 0.4, 1000.0}});
}
/// Fixed at both ends, with the upper end rotated: a twist that a factor at rest does not represent.
template <class Motion>
struct Twisting {
  Motion motion;
  int k = 0;

  explicit Twisting(const detail::CorotatedMotionOptions& options)
      : motion(column(), Scene().fix("z0").fix("z1"), options) {}
  detail::CorotatedStep move(double h) {
    const double angle = std::min(2.5, 0.02 * ++k);
    VectorX constrained = VectorX::Zero(motion.size());
    for (Index i = 0; i < constrained.size() / 3; ++i) {
      const Vector3& x = motion.body().positions[static_cast<std::size_t>(i)];
      if (x.z() < 0.079) continue;
      const double a = x.x() - 0.01, b = x.y() - 0.01, c = std::cos(angle) - 1.0, s = std::sin(angle);
      constrained.segment<3>(3 * i) = Vector3(c * a - s * b, s * a + c * b, 0.0);
    }
    motion.set_prescribed(constrained);
    return motion.step(h);
  }
};

detail::CorotatedMotionOptions solved_well() {
  detail::CorotatedMotionOptions options;
  options.solve = {200, 1e-10};
  options.precondition_every = 1;
  return options;
}

}  // namespace

TEST_CASE("a renewed factor gives the same steps in fewer iterations", "[model][corotated][renewed]") {
  Twisting<Renewed> renewed(solved_well());
  Twisting<Rotated> rotated(solved_well());
  long late = 0, late_rotated = 0;
  for (int k = 0; k < 200; ++k) {
    const detail::CorotatedStep a = renewed.move(0.02), b = rotated.move(0.02);
    REQUIRE(a.taken);
    CHECK((renewed.motion.displacement() - rotated.motion.displacement()).norm() <=
          1e-7 * rotated.motion.displacement().norm());
    if (k < 150) continue;
    if (k == 150)  // the thread may not have run yet: wait for it
      for (const long before = renewed.motion.preconditioner().renewals();
           renewed.motion.preconditioner().renewals() < before + 2;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        renewed.motion.prepare_response(0.02);
      }
    late += a.solve.iterations;
    late_rotated += b.solve.iterations;
  }
  INFO(late << " iterations against " << late_rotated);
  CHECK(late < late_rotated);
}

TEST_CASE("renewing does not allocate in the stepping thread", "[model][corotated][renewed]") {
  Twisting<Renewed> renewed(solved_well());
  renewed.move(0.02);
  const testing::AllocationScope scope;
  for (int k = 0; k < 20; ++k) renewed.motion.step(0.02);
  CHECK(scope.allocations() == 0);
}

TEST_CASE("step changes and destruction at any time are safe", "[model][corotated][renewed]") {
  for (int run = 0; run < 20; ++run) {
    Twisting<Renewed> renewed(solved_well());
    for (int k = 0; k < run; ++k) REQUIRE(renewed.move(k % 3 == 0 ? 0.02 : 0.01).solve.converged);
  }
}
