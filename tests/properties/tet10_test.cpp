#include <palpate/element/wrappers.hpp>

#include "extremes/element_extremes.hpp"
#include "properties/element_cases.hpp"
#include "properties/oracle_checks.hpp"

using namespace test;

TEST_CASE("Tet10: an affine field is reproduced on a distorted mesh, here and far away", "[property][patch]") {
  check_affine_patch<Tet10>(true);
}

TEST_CASE("Tet10: an affine field under its tractions", "[property][patch]") {
  check_traction_patch<Tet10>(true);
}

TEST_CASE("Tet10: four points are not enough for the patch test on curved edges, degree five is", "[property][patch]") {
  using Fine = WithQuadrature<Tet10, TetrahedronRule<5>>;
  const Mesh<Tet10> mesh = shaken(box_tet10({0.1, 0.08, 0.06}, {3, 2, 2}), 0.0015, false);
  Mesh<Fine> fine;
  fine.positions = mesh.positions;
  fine.elements = mesh.elements;
  CHECK(force_inside(fine) <= 1e-13);
  CHECK(force_inside(mesh) > 1e-6);
  CHECK(force_inside(mesh) < 1e-2);
  CHECK(force_inside(shaken(mesh, 0.0, true)) <= 1e-13);
}

TEST_CASE("Tet10: a quadratic field is exact on straight edges", "[property][patch]") {
  check_quadratic_patch<Tet10>();
}

TEST_CASE("Tet10: a smooth field converges with the order of the element", "[property][mms]") {
  check_convergence<Tet10>(4, 8);
}

TEST_CASE("Tet10 at the extremes: right, flagged or refused",
          "[extreme][A1][A2][A3][A4][B1][B2][B3][B4][B5][B7][B8][B9]") {
  check_extremes<Tet10>();
}

TEST_CASE("Tet10: linear statics agrees with the reference results", "[oracle]") {
  CHECK(check_folder<Tet10>(PALPATE_TEST_DATA "/oracle/B_cantilever/tet10_5x1x1", "tet10") == 2);
  CHECK(check_folder<Tet10>(PALPATE_TEST_DATA "/oracle/C_lame_sphere/tet10_h0.5", "tet10") == 1);  // curved faces
  const int checked = check_all_folders<Tet10>("tet10");
  if (checked < 0) WARN(test::no_further_results);
  CHECK(checked != 0);
}
