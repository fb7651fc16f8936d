#include "model/touch_elements.hpp"

TEST_CASE("Hex20 can be touched", "[model][touch]") {
  test::check_touch<palpate::Hex20>();
}
