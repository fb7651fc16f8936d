// g++ -std=c++20 -O2 -I<palpate>/include -I<eigen> x.cpp -pthread
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
using namespace palpate;

int main() {
  const Vector3 size = 0.0035 * Vector3(4, 2, 1);
  auto mesh = box_tet4(size, {4, 2, 1}, BoxSplit::five_mirrored, {-0.5 * size[0], -0.5 * size[1], 0.0});
  mesh.region_names = {"first", "second"};
  mesh.regions.clear();
  for (const auto& element : mesh.elements) {
    Vector3 centre = Vector3::Zero();
    for (NodeId node : element) centre += mesh.position(node);
    centre = centre / 4 - Vector3(0.0, 0.0, 0.00175);
    mesh.regions.push_back(centre[2] < -1.4000000000000002e-11 ? 1 : 0);
  }
  Scene scene;
  scene.fix("z0").touch("z1");

  using Tissue = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<float>>>;
  const RegionMaterials<NeoHookean> materials{
      {"first", {.youngs_modulus = 14000.0, .poisson_ratio = 0.3, .density = 1000.0}},
      {"second", {.youngs_modulus = 3.08e+09, .poisson_ratio = 0.3, .density = 1000.0}}};
  Tissue tissue(mesh, scene, materials, {}, {.step = 0.01, .inertia = false});

  HapticServo servo(tissue, CapsuleTool(0.0022, 0.0044, {1.0, 0.0, 0.0}), {.coupling_stiffness = 1000.0});

  const auto smooth = [](double part) {
    return 0.5 * (1.0 - std::cos(std::numbers::pi * std::clamp(part, 0.0, 1.0)));
  };
  std::cout.precision(9);
  double due = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    const double now = tick / 1000.0;
    for (; due <= now; due += tissue.step()) tissue.background_work();
    const double in = tick <= 210 ? smooth(tick / 135.0) : 1.0 - smooth((tick - 210) / 75.0);
    const double depth = 0.0022 * (-0.5 + 0.62 * in);
    ToolState state;
    state.time = state.now = now;
    state.position = Vector3(0.0015680000000000002, -0.001512, 0.0035) + (0.0022 - depth) * Vector3(0.0, 0.0, 1.0);
    const Status status = servo.tick(state).status;
    if (tick % 10 == 0)
      std::cout << tick << ' ' << depth << ' ' << servo.contact_force().transpose() << ' ' << status << '\n';
  }
}
