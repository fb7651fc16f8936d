// g++ -std=c++20 -O2 -I<palpate>/include -I<eigen> x.cpp -pthread
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
using namespace palpate;

int main() {
  const Vector3 size = 0.002 * Vector3(6, 6, 3);
  auto mesh = box_hex8(size, {6, 6, 3}, {-0.5 * size[0], -0.5 * size[1], 0.0});
  mesh.fibres.assign(mesh.elements.size(), Vector3::UnitX());
  const auto curve = [&](const Vector3& q) -> Vector3 {
    const double inner = 0.006;
    const Vector3 out = Vector3(std::tan(q[0] / 0.012), std::tan(q[1] / 0.012), 1.0).normalized();
    return (inner + q[2]) * out - inner * Vector3::UnitZ();
  };
  for (Vector3& x : mesh.positions) x = curve(x);
  Scene scene;
  scene.fix("z0").touch("z1");

  using Tissue = HapticFEModel<MeanDilatation<Hex8>, TransverselyIsotropic, Explicit<SemiImplicitEuler>>;
  Tissue tissue(mesh, scene, TransverselyIsotropic{.youngs_modulus_along = 2000.0, .youngs_modulus_across = 1000.0, .poisson_ratio_along = 0.1, .poisson_ratio_across = 0.1, .shear_modulus_along = 642.824346533225, .density = 1000.0}, {}, {.step = 0.01});

  HapticServo servo(tissue, ConvexTool({{-0.006, -0.004, 0.0}, {-0.006, 0.004, 0.0}, {0.006, -0.004, 0.0}, {0.006, 0.004, 0.0}}, 0.002), {.coupling_stiffness = 1000.0, .contact = {.friction = 0.7}});

  const auto smooth = [](double part) {
    return 0.5 * (1.0 - std::cos(std::numbers::pi * std::clamp(part, 0.0, 1.0)));
  };
  std::cout.precision(9);
  double due = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    const double now = tick / 1000.0;
    for (; due <= now; due += tissue.step()) tissue.background_work();
    const double in = tick <= 210 ? smooth(tick / 135.0) : 1.0 - smooth((tick - 210) / 75.0);
    const double depth = 0.004 * (-0.5 + 0.75 * in);
    ToolState state;
    state.time = state.now = now;
    state.position = Vector3(0.0, 0.0, 0.006) + (0.002 - depth) * Vector3(0.0, 0.0, 1.0);
    const Status status = servo.tick(state).status;
    if (tick % 10 == 0)
      std::cout << tick << ' ' << depth << ' ' << servo.contact_force().transpose() << ' ' << status << '\n';
  }
}
