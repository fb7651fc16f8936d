// Two light hands that pinch a thin lobe: do the jaws hold it, and do ticks converge?
#include "pinch.hpp"
#include "presses.hpp"

#include <palpate/mesh/generators.hpp>

#include <cstdio>

namespace presses {

bool pinches(int runs) {
  constexpr double thickness = 0.006;
  Scene scene;
  scene.fix("x0").touch("surface");
  Tissue lobe(box_tet4(Vector3(0.04, 0.012, thickness), {20, 6, 3}), scene,
              {.youngs_modulus = 2e4, .poisson_ratio = 0.45});
  testing::Random random(19);
  std::printf("\npinches of a lobe of 6 mm by two hands at %d places; unconverged ticks, mean [%%]\n", runs);
  std::printf("%-8s %9s %7s %8s %5s %12s\n", "jaws", "friction", "hands", "crossed", "lost", "unconverged");
  bool right = true;
  for (const Shape shape : {Shape::sphere, Shape::capsule, Shape::box})
    for (const double friction : {0.0, 0.1, 0.3, 0.6, 1.0})
      for (const double amplitude : {0.0, 3e-3}) {
        int crossed = 0, lost = 0, unconverged = 0;
        for (int k = 0; k < runs; ++k) {
          const Vector3 place(random.uniform(0.026, 0.032), random.uniform(0.005, 0.007), 0.0);
          const double radius = random.uniform(1.2e-3, 2e-3);
          const Pinch p = pinch(lobe, tool_of(shape, radius), radius, friction,
                                {.below = place, .thickness = thickness, .amplitude = amplitude});
          crossed += p.crossed;
          lost += p.lost;
          unconverged += p.unconverged;
        }
        std::printf("%-8s %9g %7s %8d %5d %12.2f\n", name_of(shape), friction, amplitude > 0.0 ? "moving" : "still",
                    crossed, lost, 100.0 * unconverged / (3000.0 * runs));
        std::fflush(stdout);
        right = right && (friction == 0.0 || (crossed == 0 && lost == 0));
      }
  return right;
}

}  // namespace presses
