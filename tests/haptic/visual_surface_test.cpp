// Data for a renderer, and several tissues under one tool.
#include <palpate/contact/tissue_group.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/linear/detail/indexed_vector.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/rendering/visual_surface.hpp>
#include <palpate/model/static/detail/statics.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include <atomic>
#include <numbers>
#include <thread>

#include "catch.hpp"

using namespace palpate;

namespace {

using Model = HapticFEModel<Tet4, LinearElastic>;
constexpr LinearElastic soft{1e4, 0.3, 1000.0};
constexpr double tool_radius = 4e-3;

Mesh<Tet4> block() {
  return box_tet4({0.02, 0.02, 0.01}, {6, 6, 3});
}
Scene scene() {
  return Scene().fix("z0").touch("z1").render("z1");
}

ServoOptions stiff() {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = ForceLimits{.peak_force = 1e3, .slew_rate = 1e9};
  return options;
}

template <class Servo>
Vector3 press(Servo& servo, const Vector3& at, double depth) {
  ToolState state;
  for (int i = 0; i <= 100; ++i) {
    state.time += 1e-3;
    state.position = at + Vector3(0, 0, tool_radius - depth * i / 100.0);
    servo.tick({&state, 1});
  }
  return servo.tick_view().contact_force();
}

Vector3 at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// A fine grid over the top of the block, at a distance `above`.
VisualMesh fine_top(double above) {
  VisualMesh mesh;
  constexpr int n = 40;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(0.02 * i / n, 0.02 * j / n, 0.01 + above);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + (n + 1) * j;
      mesh.triangles.push_back({a, a + 1, a + n + 2});
      mesh.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  return mesh;
}

}  // namespace

TEST_CASE("the rendered surface coincides with the surface of the body", "[model][visual]") {
  Model model(block(), scene().gravity({0, 0, -9.81}), soft);
  HapticServo servo(model, SphereTool{tool_radius}, stiff());
  VisualSurface surface(model);
  REQUIRE(surface.point_count() == 49);
  CHECK(surface.report().outside == 0);
  press(servo, {0.01, 0.01, 0.01}, 1e-3);
  std::vector<float> positions(147), normals(147);
  REQUIRE(surface.read_surface(servo.read_snapshot().vertex_forces(), positions, normals));
  VectorX u(3 * model.mesh().node_count());
  model.displacement_with(servo.read_snapshot().vertex_forces(), u);
  double lowest = 0.01;
  for (std::size_t i = 0; i < 49; ++i) {
    const NodeId node = model.rendered_nodes()[i];
    CHECK((at(positions, i) - (model.rest_position(node) + u.segment<3>(3 * Index{node}))).norm() <= 2e-9);
    CHECK(std::abs(at(normals, i).norm() - 1.0) <= 1e-6);
    CHECK(normals[3 * i + 2] > 0.5F);
    lowest = std::min(lowest, at(positions, i).z());
  }
  CHECK(lowest < 0.01 - 0.5e-3);
  // The surface has the dent of the facets, which is flatter than that of the contact points between them.
  for (std::size_t i = 0; i < 49; ++i)
    CHECK((at(positions, i) - servo.tick_view().proxy()).norm() >= 0.9 * tool_radius);
}

TEST_CASE("a fine surface follows an affine displacement exactly, on the body and above it", "[model][visual]") {
  Matrix3 a;
  a << 0.1, 0.02, 0.0, 0.03, -0.05, 0.01, 0.0, 0.04, 0.08;
  const Mesh<Tet4> mesh = block();
  Scene supported = Scene().touch("z1");
  for (NodeId i = 0; i < mesh.node_count(); ++i) {
    const Vector3 u = a * mesh.position(i);
    if (mesh.position(i).z() < 0.01 - 1e-9) supported.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  for (NodeId i = 0; i < mesh.node_count(); ++i) {
    const Vector3 u = a * mesh.position(i);
    if (mesh.position(i).z() >= 0.01 - 1e-9) supported.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  Model model(mesh, supported, soft);
  for (const double above : {-1e-4, 0.0, 5e-4}) {
    VisualSurface fine(model, fine_top(above));
    CHECK((fine.report().outside > 0) == (above > 0.0));
    if (above > 0.0) CHECK(std::abs(fine.report().worst_distance - above) <= 1e-12);
    std::vector<float> positions(static_cast<std::size_t>(3 * fine.point_count())), normals(positions.size());
    REQUIRE(fine.read_surface({}, positions, normals));
    const VisualMesh given = fine_top(above);
    for (std::size_t i = 0; i < given.positions.size(); ++i)
      CHECK((at(positions, i) - (given.positions[i] + a * given.positions[i])).norm() <= 2e-8);
  }
}

TEST_CASE("a field of the nodes is interpolated to the points of a fine surface", "[model][visual]") {
  Model model(block(), scene().gravity({0, 0, -9.81}), soft);
  VisualSurface surface(model, fine_top(1e-3));
  CHECK(surface.displacement().isZero(0.0));
  const auto points = static_cast<std::size_t>(surface.point_count());
  std::vector<float> positions(3 * points), normals(3 * points), values(points);
  REQUIRE(surface.read_surface({}, positions, normals));
  CHECK((surface.displacement() - model.displacement()).norm() <= 1e-12 * model.displacement().norm());
  VectorX field(model.mesh().node_count());  // linear in space, so that it is exact, also above the body
  for (NodeId i = 0; i < field.size(); ++i) field[i] = Vector3(3.0, -2.0, 5.0).dot(model.rest_position(i)) + 1.0;
  REQUIRE(surface.read_field(field, values));
  const VisualMesh given = fine_top(1e-3);
  double worst = 0.0;
  for (std::size_t i = 0; i < points; ++i)
    worst = std::max(worst, std::abs(values[i] - 1.0 - Vector3(3.0, -2.0, 5.0).dot(given.positions[i])));
  CHECK(worst <= 1e-6);
  CHECK_FALSE(surface.read_field(VectorX::Zero(3), values));
  CHECK_FALSE(surface.read_field(field, positions));
}

TEST_CASE("the surface follows the pose, and arrays of wrong size are refused", "[model][visual]") {
  Model model(block(), scene(), soft);
  VisualSurface surface(model);
  const auto n = static_cast<std::size_t>(3 * surface.point_count());
  std::vector<float> before(n), after(n), normals(n);
  REQUIRE(surface.read_surface({}, before, normals));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.5, Vector3::UnitX()));
  pose.pretranslate(Vector3(0.1, 0.2, 0.3));
  model.set_pose(pose);
  REQUIRE(surface.read_surface({}, after, normals));
  for (std::size_t i = 0; i < n / 3; ++i) CHECK((at(after, i) - pose * at(before, i)).norm() <= 1e-7);
  std::vector<float> few(3, 7.0F);
  CHECK(!surface.read_surface({}, few, normals));
  CHECK(!surface.read_surface({}, after, few));
  CHECK(few[0] == 7.0F);
}

TEST_CASE("invalid surfaces are refused", "[model][visual][extreme]") {
  Model model(block(), scene(), soft);
  const auto kind = [&](auto change) {
    VisualMesh mesh = fine_top(0.0);
    change(mesh);
    try {
      VisualSurface(model, mesh);
    } catch (const SetupError& error) {
      return error.kind();
    }
    return SetupErrorKind::unsupported;
  };
  CHECK(kind([](VisualMesh& m) { m.triangles.clear(); }) == SetupErrorKind::empty_mesh);
  CHECK(kind([](VisualMesh& m) { m.triangles[3][1] = -1; }) == SetupErrorKind::index_out_of_range);
  CHECK(kind([](VisualMesh& m) { m.triangles[3][2] = 1681; }) == SetupErrorKind::index_out_of_range);
  CHECK(kind([](VisualMesh& m) { m.positions[7][0] = infinity; }) == SetupErrorKind::non_finite);
}

TEST_CASE("a renderer reads while the servo ticks", "[model][visual][threads]") {
  Model model(block(), scene(), soft);
  HapticServo servo(model, SphereTool{tool_radius}, stiff());
  VisualSurface surface(model);
  std::atomic<bool> stop{false};
  std::thread hand([&] {
    ToolState state;
    for (int i = 0; i < 20'000 && !stop; ++i) {
      state.time += 1e-3;
      state.position = Vector3(0.01 + 2e-3 * std::sin(0.01 * i), 0.01, 0.01 + tool_radius - 5e-4);
      servo.tick({&state, 1});
    }
    stop = true;
  });
  std::vector<float> positions(147), normals(147);
  int frames = 0;
  while (!stop || frames == 0) {
    REQUIRE(surface.read_surface(servo.read_snapshot().vertex_forces(), positions, normals));
    bool fine = true;
    for (const float x : positions) fine = fine && std::isfinite(x) && std::abs(x) < 0.05F;
    CHECK(fine);
    if (++frames == 50) stop = true;
  }
  hand.join();
}

TEST_CASE("contacts of a snapshot carry point, normal and the whole force", "[haptic][visual]") {
  Model model(block(), scene(), soft);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.pretranslate(Vector3(0.1, 0.0, 0.0));
  model.set_pose(pose);
  HapticServo servo(model, SphereTool{tool_radius}, stiff());
  press(servo, {0.11, 0.01, 0.01}, 1e-3);
  const auto& snapshot = servo.read_snapshot();
  REQUIRE(!snapshot.tool_contacts().empty());
  Vector3 sum = Vector3::Zero();
  for (const ToolContact& c : snapshot.tool_contacts()) {
    CHECK(c.tool == 0);
    CHECK(c.force > 0.0);
    CHECK(std::abs(c.normal.norm() - 1.0) <= 1e-12);
    CHECK(std::abs((c.point - snapshot.proxies[0]).norm() - tool_radius) <= 1e-4 * tool_radius);
    CHECK((c.point - Vector3(0.11, 0.01, 0.01)).norm() < tool_radius);
    sum += c.force * c.normal;
  }
  CHECK((sum - servo.tick_view().contact_force()).norm() <= 1e-12 * sum.norm());
}

TEST_CASE("a single model in a group gives the same force as alone", "[contact][group]") {
  Model model(block(), scene(), soft);
  HapticServo alone(model, SphereTool{tool_radius}, stiff());
  const Vector3 truth = press(alone, {0.01, 0.01, 0.01}, 1e-3);
  TissueGroup group(model);
  HapticServo together(group, SphereTool{tool_radius}, stiff());
  CHECK((press(together, {0.01, 0.01, 0.01}, 1e-3) - truth).norm() <= 1e-10 * truth.norm());
}

TEST_CASE("two models of a group are touched simultaneously, each in its pose", "[contact][group]") {
  Model left(block(), scene(), soft), right(block(), scene(), {3e4, 0.3, 1000.0});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(std::numbers::pi, Vector3::UnitZ()));  // the right one rotated by 180 degrees
  pose.pretranslate(Vector3(0.0405, 0.02, 0.0));                       // 0.5 mm from the left one
  right.set_pose(pose);
  TissueGroup group(left, right);

  HapticServo servo(group, SphereTool{tool_radius}, stiff());
  const Vector3 both = press(servo, {0.02025, 0.01, 0.01}, 1e-3);
  const ServoSnapshot& snapshot = servo.read_snapshot();
  std::array<Vector3, 2> sum{Vector3::Zero(), Vector3::Zero()};
  for (std::size_t tissue : {0u, 1u})
    for (const VertexForce& f : snapshot.vertex_forces(tissue)) sum[tissue] += f.force.in_model_axes();
  CHECK(sum[0].z() < 0.0);               // both are pressed,
  CHECK(sum[1].z() < 2.0 * sum[0].z());  // the stiffer one more
  CHECK((pose.linear() * sum[1] + sum[0] + both).norm() <= 1e-10 * both.norm());

  // far from each other the force is that of one alone, up to the tolerance of a tick
  pose.pretranslate(Vector3(1.0, 0.0, 0.0));
  right.set_pose(pose);
  servo.reset();
  HapticServo alone(left, SphereTool{tool_radius}, stiff());
  const Vector3 truth = press(alone, {0.01, 0.01, 0.01}, 1e-3);
  CHECK((press(servo, {0.01, 0.01, 0.01}, 1e-3) - truth).norm() <= 1e-6 * truth.norm());
}
