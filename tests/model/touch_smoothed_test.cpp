#include <palpate/element/wrappers.hpp>

#include "model/touch_elements.hpp"

TEST_CASE("Smoothed<Tet4> can be touched, on the mesh of Tet4", "[model][touch]") {
  test::check_touch<palpate::Smoothed<palpate::Tet4>>();
}
