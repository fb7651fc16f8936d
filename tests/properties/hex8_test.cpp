#include "extremes/element_extremes.hpp"
#include "properties/element_cases.hpp"
#include "properties/oracle_checks.hpp"

using namespace test;

TEST_CASE("Hex8: an affine field is reproduced on a distorted mesh, here and far away", "[property][patch]") {
  check_affine_patch<Hex8>(false);
}

TEST_CASE("Hex8: an affine field under its tractions", "[property][patch]") {
  check_traction_patch<Hex8>(false);
}

TEST_CASE("Hex8: a smooth field converges with the order of the element", "[property][mms]") {
  check_convergence<Hex8>(4, 8);
}

TEST_CASE("Hex8 at the extremes: right, flagged or refused",
          "[extreme][A1][A2][A3][A4][B1][B2][B3][B4][B5][B7][B8][B9]") {
  check_extremes<Hex8>();
}

TEST_CASE("Hex8: linear statics agrees with the reference results", "[oracle]") {
  CHECK(check_folder<Hex8>(PALPATE_TEST_DATA "/oracle/B_cantilever/hex8_10x2x2", "hex8") == 2);
  const int checked = check_all_folders<Hex8>("hex8");
  if (checked < 0) WARN(test::no_further_results);
  CHECK(checked != 0);
}
