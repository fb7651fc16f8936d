#include <palpate/element/wrappers.hpp>

#include "extremes/element_extremes.hpp"
#include "properties/element_cases.hpp"

using namespace test;
using Averaged = Smoothed<Tet4>;

TEST_CASE("Smoothed<Tet4>: an affine field is reproduced on a distorted mesh, here and far away", "[property][patch]") {
  check_affine_patch<Averaged>(false);
}

TEST_CASE("Smoothed<Tet4>: an affine field under its tractions", "[property][patch]") {
  check_traction_patch<Averaged>(false);
}

TEST_CASE("Smoothed<Tet4>: a smooth field converges with the order of the element", "[property][mms]") {
  check_convergence<Averaged>(6, 12);
}

TEST_CASE("Smoothed<Tet4> at the extremes: right, flagged or refused",
          "[extreme][A1][A2][A3][A4][B1][B2][B3][B4][B5][B7][B8][B9]") {
  check_extremes<Averaged>();
}
