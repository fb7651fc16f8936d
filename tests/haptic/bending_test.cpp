// Presses that bend a thin body, and presses at edges of a thick one: right within a tenth, or flagged.
#include <palpate/element/hex8.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/generators_box.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <cmath>
#include <numbers>

using namespace palpate;

namespace {

constexpr double tool_radius = 4e-3;

template <class E>
using BentOrgan = HapticFEModel<E, LinearElastic, Condensed<SelectiveInverse>>;

struct BendingPress {
  double force;  // [N]
  bool flagged;
};

/// Presses a sphere along `direction` until it is `depth` below the point `at` of the surface, then holds it.
template <class E>
BendingPress press_along(const Mesh<E>& mesh, Scene scene, double poisson_ratio, const Vector3& at,
                         const Vector3& direction, double depth) {
  scene.touch(where::sphere(at, 3.0 * tool_radius));
  BentOrgan<E> organ(mesh, scene, LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = poisson_ratio});
  ServoOptions options;
  options.force_limits = test::open_gate();
  options.coupling_stiffness = infinity;
  HapticServo servo(organ, SphereTool{.radius = tool_radius}, options);
  BendingPress result{};
  for (int k = 0; k < 120; ++k) {
    ToolState s;
    s.position = at + (depth * std::min(1.0, k / 100.0) - tool_radius) * direction;
    s.time = 1e-3 * k;
    result.flagged = servo.tick(s).status.has(StatusFlag::coarse_contact);
  }
  result.force = -servo.contact_force().dot(direction);
  return result;
}

/// A lobe that is fixed at one end, pressed in the middle of its free half.
template <class E>
BendingPress bend_lobe(const Mesh<E>& mesh, double poisson_ratio) {
  Scene scene;
  scene.fix("x0");
  return press_along<E>(mesh, scene, poisson_ratio, Vector3(0.0301, 0.0122, 0.006), -Vector3::UnitZ(), 2e-3);
}

const Vector3 lobe_size(0.04, 0.024, 0.006);

void check_bending(const char* element, int layers, const BendingPress& p, double truth) {
  CAPTURE(element, layers, p.force / truth);
  CHECK((std::abs(p.force / truth - 1.0) < 0.1 || p.flagged));
}

template <class E>
Mesh<E> rim_block(int cells) {
  return copy_mesh<E>(box_tet4(Vector3(0.03, 0.03, 0.02), {cells, cells, cells * 2 / 3}, BoxSplit::six));
}

}  // namespace

TEST_CASE("a thin lobe that is too stiff in bending for its elements is flagged", "[haptic][contact][extreme]") {
  const double poisson_ratio = GENERATE(0.3, 0.45);
  const double truth = bend_lobe<Tet10>(box_tet10(lobe_size, {14, 8, 3}), poisson_ratio).force;
  int wrong = 0;
  for (const int layers : {1, 2, 3}) {
    const std::array<int, 3> cells{7 * layers, 4 * layers, layers};
    const auto tetrahedra = box_tet4(lobe_size, cells);
    const BendingPress linear = bend_lobe<Tet4>(tetrahedra, poisson_ratio);
    check_bending("Tet4", layers, linear, truth);
    check_bending("Smoothed<Tet4>", layers,
                  bend_lobe<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(tetrahedra), poisson_ratio), truth);
    check_bending("Hex8", layers, bend_lobe<Hex8>(box_hex8(lobe_size, cells), poisson_ratio), truth);
    wrong += linear.force > 1.1 * truth;
  }
  CHECK(wrong >= 2);
}

TEST_CASE("layers of elements count, not the length of their facets or a support along the other side",
          "[haptic][contact]") {
  const double truth = bend_lobe<Tet10>(box_tet10(lobe_size, {14, 8, 3}), 0.3).force;
  const auto fine = box_tet4(lobe_size, {28, 16, 1}, BoxSplit::six);  // facets of a quarter of the thickness
  check_bending("Tet4", 1, bend_lobe<Tet4>(fine, 0.3), truth);
  Scene scene;
  scene.fix("x0").prescribe("z0", Components{std::nullopt, 0.0, std::nullopt});
  const auto on_rail = [&]<class E>(const Mesh<E>& mesh) {
    return press_along<E>(mesh, scene, 0.3, Vector3(0.0301, 0.0122, 0.006), -Vector3::UnitZ(), 2e-3);
  };
  const double truth_on_rail = on_rail(box_tet10(lobe_size, {14, 8, 3})).force;
  check_bending("Tet4", 1, on_rail(box_tet4(lobe_size, {7, 4, 1})), truth_on_rail);
  check_bending("Tet4", 2, on_rail(box_tet4(lobe_size, {14, 8, 2})), truth_on_rail);
}

TEST_CASE("a lobe with enough elements across it is right and not flagged", "[haptic][contact]") {
  const double truth = bend_lobe<Tet10>(box_tet10(lobe_size, {14, 8, 3}), 0.45).force;
  const BendingPress p = bend_lobe<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(box_tet4(lobe_size, {28, 16, 4})), 0.45);
  CAPTURE(p.force / truth);
  CHECK(std::abs(p.force / truth - 1.0) < 0.1);
  CHECK_FALSE(p.flagged);
}

TEST_CASE("presses at the rim of a thick block are flagged on the edge, and right beside it", "[haptic][contact]") {
  Scene scene;
  scene.fix("z0");
  const double beside = GENERATE(0.0, 1e-3, 4e-3), depth = GENERATE(0.5e-3, 1.5e-3);
  const Vector3 at(0.03 - beside, 0.0147, 0.02);
  const double truth =
      press_along<Smoothed<Tet4>>(rim_block<Smoothed<Tet4>>(24), scene, 0.4, at, -Vector3::UnitZ(), depth).force;
  const auto check = [&](const BendingPress& p) {
    CAPTURE(beside, depth, p.force / truth);
    CHECK((std::abs(p.force / truth - 1.0) < 0.1 || p.flagged));
    return p.flagged;
  };
  for (const int cells : {3, 6}) {
    const bool far = beside > 0.5 * 0.03 / cells;  // half of a facet
    CHECK_FALSE((check(press_along<Tet4>(rim_block<Tet4>(cells), scene, 0.4, at, -Vector3::UnitZ(), depth)) && far));
    CHECK_FALSE((check(press_along<Smoothed<Tet4>>(rim_block<Smoothed<Tet4>>(cells), scene, 0.4, at, -Vector3::UnitZ(),
                                                   depth)) &&
                 far));
  }
}

TEST_CASE("a layer of two elements on a base is right and not flagged", "[haptic][contact]") {
  Scene scene;
  scene.fix("z0");
  const auto layer = [&](int layers) {
    const auto mesh = box_tet4(Vector3(0.03, 0.03, 0.008), {layers * 4, layers * 4, layers}, BoxSplit::six);
    return press_along<Tet4>(mesh, scene, 0.3, Vector3(0.0147, 0.0159, 0.008), -Vector3::UnitZ(), 0.5e-3);
  };
  const BendingPress p = layer(2);
  CHECK(std::abs(p.force / layer(6).force - 1.0) < 0.1);
  CHECK_FALSE(p.flagged);
}

TEST_CASE("a sharp edge that is pressed along its bisector is right within a tenth, or flagged", "[haptic][contact]") {
  Scene scene;
  scene.fix("z0");
  const double depth = GENERATE(0.5e-3, 1.5e-3);
  const Vector3 at(0.03, 0.0147, 0.02), bisector(-std::numbers::sqrt2 / 2.0, 0.0, -std::numbers::sqrt2 / 2.0);
  const double truth = press_along<Tet4>(rim_block<Tet4>(36), scene, 0.4, at, bisector, depth).force;
  for (const int cells : {3, 6, 12}) {
    const BendingPress p = press_along<Tet4>(rim_block<Tet4>(cells), scene, 0.4, at, bisector, depth);
    CAPTURE(depth, cells, p.force / truth);
    CHECK((std::abs(p.force / truth - 1.0) < 0.1 || p.flagged));
  }
}
