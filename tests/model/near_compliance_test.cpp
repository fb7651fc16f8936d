#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/moving/detail/near_compliance.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <array>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("the compliance near contacts is known for listed pairs only, as many as there is room for", "[model]") {
  NearCompliance near(10, 3, 2);
  int evaluated = 0;
  const auto number = [&](int i, int j) -> Matrix3 {
    ++evaluated;
    return Matrix3::Constant(100.0 * i + j);
  };
  CHECK(near.find(1, 1) == nullptr);
  near.set(std::array{7, 2, 9, 4}, std::array{2, 5, 1}, number);
  CHECK(evaluated == 6);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      const bool listed = (i == 7 || i == 2 || i == 9) && (j == 2 || j == 5);
      REQUIRE((near.find(i, j) != nullptr) == listed);
      if (listed) REQUIRE(*near.find(i, j) == Matrix3::Constant(100.0 * i + j));
    }
  near.set(std::array{3}, std::array{3}, number);
  CHECK(*near.find(3, 3) == Matrix3::Constant(303.0));
  CHECK(near.find(7, 2) == nullptr);
  near.set({}, {}, number);
  CHECK(near.find(3, 3) == nullptr);
}

TEST_CASE("a tick gets the same compliance whether the stepping thread evaluated it or not", "[model][moving]") {
  const auto mesh = box_tet4({0.04, 0.04, 0.02}, {6, 6, 3}, BoxSplit::six);
  const Scene scene = Scene().fix("z0").touch("z1");
  HapticFEModel<Tet4, NeoHookean, Implicit<QuasiNewton<double>>> tissue(
      mesh, scene, {.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0}, {}, {.inertia = false});
  HapticServo servo(tissue, SphereTool{.radius = 6e-3});
  for (int k = 0; k < 200; ++k) {
    const ToolState s{.position = {0.02, 0.02, 0.026 - 4e-5 * std::min(k, 100)}, .time = 1e-3 * k};
    servo.tick({&s, 1});
    if (k % 16 == 0) tissue.advance();
  }
  REQUIRE(servo.contact_force().norm() > 1e-3);
  const int vertices = tissue.contact_surface().vertex_count();
  std::vector<Matrix3> listed;
  for (int i = 0; i < vertices; ++i)
    for (int j = 0; j < vertices; ++j) listed.push_back(tissue.compliance(i, j));
  // Two steps without a tick's list, and with the same forces: a state at rest.
  std::vector<VertexForce> forces;
  const ServoSnapshot snapshot = servo.read_snapshot();
  forces.assign(snapshot.vertex_forces().begin(), snapshot.vertex_forces().end());
  tissue.begin_tick();
  tissue.end_tick(forces);
  tissue.advance();
  tissue.begin_tick();
  double worst = 0.0, largest = 0.0;
  for (int i = 0, k = 0; i < vertices; ++i)
    for (int j = 0; j < vertices; ++j, ++k) {
      worst = std::max(worst, (tissue.compliance(i, j) - listed[static_cast<std::size_t>(k)]).norm());
      largest = std::max(largest, listed[static_cast<std::size_t>(k)].norm());
    }
  CHECK(worst < 1e-3 * largest);
}
