#include <palpate/element/wrappers.hpp>

#include "extremes/element_extremes.hpp"
#include "properties/element_cases.hpp"

using namespace test;
using Cured = MeanDilatation<Hex8>;

TEST_CASE("MeanDilatation<Hex8>: an affine field is reproduced on a distorted mesh, here and far away",
          "[property][patch]") {
  check_affine_patch<Cured>(false);
}

TEST_CASE("MeanDilatation<Hex8>: an affine field under its tractions", "[property][patch]") {
  check_traction_patch<Cured>(false);
}

TEST_CASE("MeanDilatation<Hex8>: a smooth field converges with the order of the element", "[property][mms]") {
  check_convergence<Cured>(4, 8);
}

TEST_CASE("MeanDilatation<Hex8> at the extremes: right, flagged or refused",
          "[extreme][A1][A2][A3][A4][B1][B2][B3][B4][B5][B7][B8][B9]") {
  check_extremes<Cured>();
}
