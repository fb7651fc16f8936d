// One session program for models of all solvers: only the line `using Model = ...` differs.
#pragma once

#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/rendering/visual_surface.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <sstream>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "refused.hpp"

namespace one_session {

using namespace palpate;

inline constexpr double radius = 0.012;
inline const Vector3 size(0.06, 0.06, 0.03);

inline Mesh<Tet4> block() {
  return box_tet4(size, {6, 6, 3});
}
template <class E>
auto block_of() {
  if constexpr (E::nodes == 10)
    return promote<E>(box_tet4(size, {4, 4, 2}));
  else
    return block();
}
/// Young's modulus 5 kPa, Poisson ratio 0.4.
template <class M>
M material(double nu = 0.4) {
  return M{5e3, nu, 1000.0};
}
inline Scene constrained_block() {
  return Scene().fix("z0").touch("z1");
}

/// Forces [N] of a tool pressed `depth` into the middle of the block at its pose, one per tick of 1 ms. Background work
/// is done between the ticks, so that every run is the same.
template <class Model>
std::vector<Vector3> press(Model& model, HapticServo& servo, double depth, int ticks = 600) {
  std::vector<Vector3> forces;
  double next = 0.0;
  for (int k = 0; k < ticks; ++k) {
    if constexpr (HasBackgroundWork<Model>)
      if (1e-3 * k >= next - 1e-9) next += model.background_work().next;
    ToolState state;
    state.time = 1e-3 * k;
    const double in = std::min(depth, 0.02 * state.time);
    state.position = model.pose() * Vector3(0.5 * size[0], 0.5 * size[1], size[2] + radius - in);
    forces.push_back(servo.tick(state).force());
    REQUIRE(forces.back().allFinite());
  }
  return forces;
}
inline ServoOptions stiff_device() {
  ServoOptions o;
  o.devices = {{.peak_force = 20.0, .stiffness = 2000.0}};
  return o;
}

template <class Model>
double lowest_point(VisualSurface<Model>& surface, std::span<const VertexForce> forces) {
  surface.update();
  std::vector<float> positions(3 * static_cast<std::size_t>(surface.point_count())), normals(positions.size());
  REQUIRE(surface.read_surface(forces, positions, normals));
  float lowest = 1.0f;  // of the points over the middle of the top
  for (std::size_t i = 0; i < positions.size(); i += 3)
    if (std::abs(positions[i] - 0.03f) < 0.004f && std::abs(positions[i + 1] - 0.03f) < 0.004f &&
        positions[i + 2] > 0.015f)
      lowest = std::min(lowest, positions[i + 2]);
  return lowest;
}

template <class Mesh>
Index nodes_below(const Mesh& mesh) {
  return static_cast<Index>(
      std::ranges::count_if(mesh.positions, [](const Vector3& x) { return std::abs(x[2]) < 1e-9; }));
}

/// Set-up, report, touch, render, pose, loads, reset and refusals.
template <class Model>
void run() {
  using E = typename Model::ElementType;
  using M = typename Model::MaterialType;
  const auto mesh = block_of<E>();
  int stages = 0;
  Model model(mesh, constrained_block(), material<M>(), {.progress = [&](const Progress&) { return ++stages > 0; }});

  CHECK(stages > 0);
  CHECK(model.report().nodes == mesh.node_count());
  CHECK(model.report().touchable_vertices == static_cast<Index>(model.touchable_nodes().size()));
  CHECK(model.report().free_dofs == 3 * (model.report().nodes - nodes_below(mesh)));
  CHECK(model.report().kept_dofs == 3 * model.report().touchable_vertices);
  CHECK(!model.report().has(SetupFlag::locking));
  std::ostringstream text;
  text << model.report();
  CHECK(text.str().size() > 100);

  HapticServo servo(model, SphereTool{.radius = radius}, stiff_device());
  VisualSurface surface(model);
  const double flat = lowest_point(surface, {});
  CHECK(std::abs(flat - size[2]) < 1e-4);
  const std::vector<Vector3> first = press(model, servo, 0.004);
  const double force = first.back()[2];
  CHECK(force > 0.2);
  CHECK(force < 2.0);
  CHECK(first.back().head<2>().norm() < 0.05 * force);
  CHECK(servo.read_snapshot().tool_contacts().size() > 0);
  const std::vector<VertexForce> pressing(servo.read_snapshot().vertex_forces().begin(),
                                          servo.read_snapshot().vertex_forces().end());
  CHECK(lowest_point(surface, pressing) < size[2] - 0.002);
  const VectorX u = model.displacement(pressing);
  CHECK(u.size() == 3 * model.mesh().node_count());
  CHECK(u.minCoeff() < -0.002);
  CHECK_REFUSED(SetupErrorKind::index_out_of_range,
                model.displacement(std::array{VertexForce{1000000, {0.0, 0.0, 1.0}}}));

  // Reset restores the initial state exactly.
  servo.reset();
  model.reset();
  CHECK((press(model, servo, 0.004) == first));

  // A rotated and translated organ gives the same forces, rotated with it.
  servo.reset();
  model.reset();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(2.0, Vector3(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  pose.translation() = Vector3(0.4, -0.1, 1.3);
  model.set_pose(pose);
  CHECK(model.pose().matrix() == pose.matrix());
  const Vector3 rotated = pose.linear().transpose() * press(model, servo, 0.004).back();
  CHECK((rotated - first.back()).norm() < 2e-3 * force);
  Eigen::Isometry3d scaled = pose;
  scaled.linear() *= 1.5;
  CHECK_REFUSED(SetupErrorKind::bad_argument, model.set_pose(scaled));
  CHECK(model.pose().matrix() == pose.matrix());

  // Gravity deforms the block equally by set_gravity and by set_conditions; other supports are refused.
  const auto sunk = [&](const auto& change) {
    model.reset();
    servo.reset();
    change();
    press(model, servo, -0.01);
    return model.displacement(std::span<const VertexForce>{}).minCoeff();
  };
  CHECK(std::abs(sunk([] {})) < 1e-5);
  const double by_gravity = sunk([&] { model.set_gravity({0.0, 0.0, -9.81}); });
  CHECK(by_gravity < -5e-4);
  const double by_scene = sunk([&] { model.set_conditions(constrained_block().gravity({0.0, 0.0, -9.81})); });
  CHECK(std::abs(by_scene - by_gravity) < 0.01 * std::abs(by_gravity));
  CHECK_REFUSED(SetupErrorKind::unsupported, model.set_conditions(Scene().fix("z0").fix("x0").touch("z1")));
  CHECK_REFUSED(SetupErrorKind::unsupported, model.set_conditions(Scene().fix("z0").touch("x1")));
  CHECK_REFUSED(SetupErrorKind::non_finite, model.set_gravity({0.0, infinity, 0.0}));

  // The background work in a thread.
  model.reset();
  servo.reset();
  {
    const BackgroundWorker worker(model);
    for (int k = 0; k < 50; ++k) {
      ToolState state;
      state.time = 1e-3 * k;
      state.position = Vector3(0.5 * size[0], 0.5 * size[1], size[2] + radius - 5e-5 * k);
      CHECK(servo.tick(state).force().allFinite());
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    const WorkerReport report = worker.report();
    CHECK(report.rate >= 0.0);
  }

  // Errors and flags.
  CHECK_REFUSED(SetupErrorKind::unconstrained, Model(mesh, Scene().touch("z1"), material<M>()));
  CHECK_REFUSED(SetupErrorKind::unknown_group, Model(mesh, Scene().fix("nowhere").touch("z1"), material<M>()));
  auto bad = mesh;
  std::swap(bad.elements[7][0], bad.elements[7][1]);
  CHECK_REFUSED(SetupErrorKind::inverted_element, Model(bad, constrained_block(), material<M>()));
  if constexpr (requires { E::locking_poisson_ratio; })
    if (E::locking_poisson_ratio < 0.48) {
      const Model locks(mesh, constrained_block(), material<M>(0.49));
      CHECK(locks.report().has(SetupFlag::locking));
    }
}

}  // namespace one_session
