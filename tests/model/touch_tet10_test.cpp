#include "model/touch_elements.hpp"

TEST_CASE("Tet10 can be touched", "[model][touch]") {
  test::check_touch<palpate::Tet10>();
}
