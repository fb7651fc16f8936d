// Presses that bend a thin body: right within a tenth, or flagged.
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/generators_box.hpp>

#include "haptic/sphere_press.hpp"

#include "catch.hpp"

#include <cmath>

using namespace palpate;

namespace {

/// A press of a sphere of 4 mm on a lobe, 2 mm deep, in the middle of its free half.
template <class E>
test::SpherePress press_lobe(const Mesh<E>& mesh, Scene scene, double poisson_ratio) {
  const Vector3 at(0.0301, 0.0122, 0.006);
  scene.fix("x0").touch(where::sphere(at, 0.012));
  HapticFEModel<E, LinearElastic, Condensed<SelectiveInverse>> organ(
      mesh, scene, LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = poisson_ratio});
  return test::press_sphere(organ, 4e-3, at, -Vector3::UnitZ(), 2e-3);
}

/// The same without other supports than one end.
template <class E>
test::SpherePress bend_lobe(const Mesh<E>& mesh, double poisson_ratio) {
  return press_lobe<E>(mesh, {}, poisson_ratio);
}

const Vector3 lobe_size(0.04, 0.024, 0.006);

void check_bending(const char* element, int layers, const test::SpherePress& p, double truth) {
  CAPTURE(element, layers, p.force / truth);
  CHECK((std::abs(p.force / truth - 1.0) < 0.1 || p.status.has(StatusFlag::coarse_contact)));
}

}  // namespace

TEST_CASE("a thin lobe that is too stiff in bending for its elements is flagged", "[haptic][contact][extreme]") {
  const double poisson_ratio = GENERATE(0.3, 0.45);
  const double truth = bend_lobe<Tet10>(box_tet10(lobe_size, {14, 8, 3}), poisson_ratio).force;
  int wrong = 0;
  for (const int layers : {1, 2, 3}) {
    const std::array<int, 3> cells{7 * layers, 4 * layers, layers};
    const auto tetrahedra = box_tet4(lobe_size, cells);
    const test::SpherePress linear = bend_lobe<Tet4>(tetrahedra, poisson_ratio);
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
  scene.prescribe("z0", Components{std::nullopt, 0.0, std::nullopt});
  const auto on_rail = [&]<class E>(const Mesh<E>& mesh) { return press_lobe<E>(mesh, scene, 0.3); };
  const double truth_on_rail = on_rail(box_tet10(lobe_size, {14, 8, 3})).force;
  check_bending("Tet4", 1, on_rail(box_tet4(lobe_size, {7, 4, 1})), truth_on_rail);
  check_bending("Tet4", 2, on_rail(box_tet4(lobe_size, {14, 8, 2})), truth_on_rail);
}

TEST_CASE("a lobe with enough elements across it is right and not flagged", "[haptic][contact]") {
  const double truth = bend_lobe<Tet10>(box_tet10(lobe_size, {14, 8, 3}), 0.45).force;
  const test::SpherePress p =
      bend_lobe<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(box_tet4(lobe_size, {28, 16, 4})), 0.45);
  CAPTURE(p.force / truth);
  CHECK(std::abs(p.force / truth - 1.0) < 0.1);
  CHECK_FALSE(p.status.has(StatusFlag::coarse_contact));
}
