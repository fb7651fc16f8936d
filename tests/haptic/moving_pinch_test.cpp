// Two light hands that pinch a lobe and swing it.
#include <palpate/contact/tools.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include "../../benchmarks/presses/pinch.hpp"
#include "catch.hpp"

using namespace palpate;

namespace {

using Lobe = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

}  // namespace

TEST_CASE("jaws with friction that swing a lobe hold it, and few ticks do not converge", "[haptic][servo][pinch]") {
  Scene scene;
  scene.fix("x0").touch("surface");
  Lobe lobe(box_tet4(Vector3(0.04, 0.012, 0.006), {20, 6, 3}), scene,
            LinearElastic{.youngs_modulus = 2e4, .poisson_ratio = 0.45});
  const double radius = 1.5e-3;
  int unconverged = 0;
  for (const double friction : {0.1, 1.0})
    for (const Tool& jaw :
         {Tool(CapsuleTool(radius, 4e-3, {0, 1, 0})), Tool(ConvexTool::box({10e-3, 6e-3, 3e-3}, radius))}) {
      const presses::Pinch result =
          presses::pinch(lobe, jaw, radius, friction,
                         {.below = {0.03, 0.006, 0.0}, .thickness = 0.006, .closing = 14e-3, .amplitude = 3e-3});
      CHECK_FALSE(result.crossed);
      unconverged += result.unconverged;
    }
  CHECK(unconverged <= 100);  // of 12,000
}
