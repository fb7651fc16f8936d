// Presses at sharp edges of a block: right within a tenth, or flagged.
#include <palpate/element/wrappers.hpp>

#include "haptic/sphere_press.hpp"

#include "catch.hpp"

#include <cmath>
#include <numbers>

using namespace palpate;

namespace {

/// A press of a sphere of 4 mm on a block of 30 x 30 x 20 mm that is fixed below.
template <class E>
test::SpherePress press_block(int cells, const Vector3& at, const Vector3& direction, double depth) {
  Scene scene;
  scene.fix("z0").touch(where::sphere(at, 0.012));
  const auto mesh = copy_mesh<E>(box_tet4(Vector3(0.03, 0.03, 0.02), {cells, cells, cells * 2 / 3}, BoxSplit::six));
  HapticFEModel<E, LinearElastic, Condensed<SelectiveInverse>> block(
      mesh, scene, LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.4});
  return test::press_sphere(block, 4e-3, at, direction, depth);
}

bool is_flagged(const test::SpherePress& p) {
  return p.status.has(StatusFlag::coarse_contact);
}

}  // namespace

TEST_CASE("presses at the rim of a face are right or flagged, and not flagged half a facet beside it",
          "[haptic][contact][extreme]") {
  const double beside = GENERATE(0.0, 1e-3, 4e-3), depth = GENERATE(0.5e-3, 1.5e-3);
  const Vector3 at(0.03 - beside, 0.0147, 0.02), down = -Vector3::UnitZ();
  const double truth = press_block<Smoothed<Tet4>>(24, at, down, depth).force;
  for (const int cells : {3, 6})
    for (const auto& p :
         {press_block<Tet4>(cells, at, down, depth), press_block<Smoothed<Tet4>>(cells, at, down, depth)}) {
      CAPTURE(beside, depth, cells, p.force / truth);
      CHECK((std::abs(p.force / truth - 1.0) < 0.1 || is_flagged(p)));
      if (beside > 0.5 * 0.03 / cells) CHECK_FALSE(is_flagged(p));
    }
}

TEST_CASE("a sharp edge that is pressed along its bisector is right within a tenth, or flagged", "[haptic][contact]") {
  const double depth = GENERATE(0.5e-3, 1.5e-3);
  const Vector3 at(0.03, 0.0147, 0.02), bisector(-std::numbers::sqrt2 / 2.0, 0.0, -std::numbers::sqrt2 / 2.0);
  const double truth = press_block<Tet4>(36, at, bisector, depth).force;
  for (const int cells : {3, 6, 12}) {
    const test::SpherePress p = press_block<Tet4>(cells, at, bisector, depth);
    CAPTURE(depth, cells, p.force / truth);
    CHECK((std::abs(p.force / truth - 1.0) < 0.1 || is_flagged(p)));
  }
}
