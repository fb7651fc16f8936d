#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/contact/detail/near_compliance.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <palpate/testing/random.hpp>

#include <array>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("the compliance near contacts is known for listed pairs only, as many as there is room for", "[model]") {
  detail::NearCompliance near(10, 3, 2);
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

TEST_CASE("the displacement near contacts is the sum over the forces whose blocks are known", "[model]") {
  testing::Random random(3);
  detail::NearCompliance near(6, 4, 3);
  near.set(std::array{0, 1, 2, 5}, std::array{4, 0, 5}, [&](int, int) {
    Matrix3 c;
    for (Index k = 0; k < 9; ++k) c.data()[k] = random.uniform(-1.0, 1.0);
    return c;
  });
  std::vector<VertexForce> forces;
  for (const int j : {5, 1, 4, 0, 5, 3})
    forces.push_back({j, ModelVector(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0))});
  for (int i = 0; i < 6; ++i) {
    const Vector3 start(1.0, 2.0, 3.0);
    Vector3 sum = start, u = start;
    std::vector<int> expected, unknown;
    for (const VertexForce& f : forces)
      if (const Matrix3* c = near.find(i, f.vertex))
        sum += *c * f.force.in_model_axes();
      else
        expected.push_back(f.vertex);
    near.multiply(i, forces, u, [&](const VertexForce& f) { unknown.push_back(f.vertex); });
    CHECK((u - sum).norm() < 1e-14);
    CHECK(unknown == expected);
    CHECK(unknown.size() == (i == 3 || i == 4 ? 6 : 2));
  }
}

namespace {

using NearTissue = HapticFEModel<Tet4, NeoHookean, Implicit<QuasiNewton<double>>>;
static_assert(detail::HasOwnDisplacement<NearTissue>);

/// Its compliance is another one than that of the class that sums displacements.
struct StifferNearTissue : NearTissue {
  using NearTissue::NearTissue;
  Matrix3 compliance(int i, int j) const noexcept { return 0.5 * NearTissue::compliance(i, j); }
};
static_assert(!detail::HasOwnDisplacement<StifferNearTissue>);

}  // namespace

TEST_CASE("a tick gets the same compliance whether the stepping thread evaluated it or not", "[model][moving]") {
  const auto mesh = box_tet4({0.04, 0.04, 0.02}, {6, 6, 3}, BoxSplit::six);
  const Scene scene = Scene().fix("z0").touch("z1");
  NearTissue tissue(mesh, scene, {.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0}, {},
                    {.inertia = false});
  HapticServo servo(tissue, SphereTool{.radius = 6e-3});
  for (int k = 0; k < 200; ++k) {
    const ToolState s{.position = {0.02, 0.02, 0.026 - 4e-5 * std::min(k, 100)}, .time = 1e-3 * k};
    servo.tick({&s, 1});
    if (k % 16 == 0) tissue.advance();
  }
  REQUIRE(servo.tick_view().contact_force().norm() > 1e-3);
  const int vertices = tissue.contact_surface().vertex_count();
  for (int i = 0; i < vertices; ++i) {
    const ServoSnapshot pressed = servo.read_snapshot();
    Vector3 sum = Vector3::Zero();
    for (const VertexForce& f : pressed.vertex_forces())
      sum += tissue.compliance(i, f.vertex) * f.force.in_model_axes();
    REQUIRE((tissue.displacement_of(i, pressed.vertex_forces()) - sum).norm() < 1e-12 * sum.norm());
  }
  // The surface without forces and the displacement by those of the step are where the step ended.
  const ContactSurface& surface = tissue.contact_surface();
  const VectorX moved = tissue.displacement();
  REQUIRE(surface.expected().is_known());
  for (int i = 0; i < vertices; ++i) {
    const NodeId node = tissue.touchable_nodes()[static_cast<std::size_t>(i)];
    const Vector3& start = surface.unloaded().positions[static_cast<std::size_t>(i)];
    const Vector3 at = start + node_vector(moved, Index{node});
    REQUIRE((surface.expected().position(i) - at).norm() < 1e-12);
  }
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
