#include <palpate/element/wrappers.hpp>

#include "model/touch_elements.hpp"

TEST_CASE("Hex8 can be touched", "[model][touch]") {
  test::check_touch<palpate::Hex8>();
}
TEST_CASE("MeanDilatation<Hex8> can be touched, on the mesh of Hex8", "[model][touch]") {
  test::check_touch<palpate::MeanDilatation<palpate::Hex8>>();
}
