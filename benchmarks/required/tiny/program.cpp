// A small haptic program to measure the cost of each policy: measure.sh compiles it with the macros below.
//   program <ticks>     presses a sphere into a block for `ticks` ticks, and prints the force
#ifdef TINY_UMBRELLA
#include <palpate/palpate.hpp>
#else
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/scene.hpp>
#ifdef TINY_ELEMENT_HEADER
#include TINY_ELEMENT_HEADER
#endif
#ifdef TINY_SOFT
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/implicit.hpp>
#elif defined(TINY_SOLVER)
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#endif
#endif

#include <cstdio>
#include <cstdlib>

using namespace palpate;

#if defined(TINY_SOLVER) || defined(TINY_SOFT)
template <class Servo>
int press(Servo& servo, int ticks) {
  ToolState state;
  for (int i = 0; i < ticks; ++i) {
    state.position << 0.017 + 1e-3 * (i % 50) / 50.0, 0.016, 0.0135;
    state.time = 1e-3 * i;
    servo.tick({&state, 1});
  }
  const double force = servo.tick_view().contact_force().norm();
  std::printf("%.6g N\n", force);
  return force > 0.0 && force < 10.0 ? 0 : 1;
}
#endif

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::atoi(argv[1]) : 1000;
#ifdef TINY_PROMOTE
  const std::array<int, 3> cells{8, 8, 3};  // as many nodes as the other meshes
#else
  const std::array<int, 3> cells{16, 16, 6};
#endif
  const Mesh<Tet4> mesh = box_tet4(Vector3(0.032, 0.032, 0.012), cells, BoxSplit::six);
  Scene scene;
  scene.fix("z0").touch("z1");
#ifdef TINY_SOFT
  HapticFEModel<Tet4, NeoHookean, Implicit<Newton>> tissue(mesh, scene, {10e3, 0.45, 1000.0});
  HapticServo servo(tissue, SphereTool{.radius = 4e-3});
  return press(servo, ticks);
#elif defined(TINY_SOLVER)
#ifdef TINY_PROMOTE
  HapticFEModel<TINY_ELEMENT, LinearElastic, TINY_SOLVER> model(promote<TINY_ELEMENT>(mesh), scene,
                                                                {10e3, 0.45, 1000.0});
#else
  HapticFEModel<TINY_ELEMENT, LinearElastic, TINY_SOLVER> model(mesh, scene, {10e3, 0.45, 1000.0});
#endif
  HapticServo servo(model, SphereTool{.radius = 4e-3});
  return press(servo, ticks);
#else
  return mesh.element_count() > ticks - ticks ? 0 : 1;
#endif
}
