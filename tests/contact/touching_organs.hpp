// Organs that touch each other, and ticks beside their worker, shared by tests.
#pragma once

#include <palpate/contact/touching_tissues.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace touching_test {

using namespace palpate;

using Static = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
using Moving = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;

inline constexpr double side = 20e-3;

inline Mesh<Tet4> box(double width, double height, std::array<int, 3> cells, double z, double corner = 0.0) {
  return box_tet4({width, width, height}, cells, BoxSplit::five_mirrored, {corner, corner, z});
}
/// A ridge along x, at z = 0.
inline Mesh<Tet4> wedge_mesh() {
  Mesh<Tet4> mesh = box(side, 10e-3, {6, 4, 5}, -10e-3, -0.5 * side);
  for (Vector3& x : mesh.positions) x[1] *= (1e-6 - x[2]) / 10e-3;
  return mesh;
}
constexpr LinearElastic linear(double youngs_modulus, double poisson_ratio = 0.45) {
  return {.youngs_modulus = youngs_modulus, .poisson_ratio = poisson_ratio, .density = 1000.0};
}
inline Eigen::Isometry3d lowered(double by) {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -by));
}

/// A pad of 10 mm, and above it a sheet of 5 mm that is fixed at two sides.
template <class Below = Static, class Above = Static>
struct Stack {
  Below below;
  Above above;
  explicit Stack(int cells = 6, int more = 0)
      : below(box(side, 10e-3, {cells, cells, cells / 2}, -10e-3), Scene().fix("z0").touch("z1"), {5e3, 0.45, 1000.0}),
        above(box(side, 5e-3, {cells + more, cells + more, 2}, 0.0),
              Scene().fix("x0").fix("x1").touch("z0").touch("z1"), {10e3, 0.45, 1000.0}) {}
};

inline ServoOptions open_options() {
  ServoOptions options{.coupling_stiffness = 1000.0};
  options.force_limits = test::open_gate();
  return options;
}

/// A sphere of 4 mm over the middle of the sheet, lowered to `depth` within 200 ticks, kept there for 200.
/// `between` is called after every tick; `status` is that of the last 100.
template <class Between>
double press(const TissueGroup& group, double depth, Between between, Status* status = nullptr) {
  HapticServo servo(group, SphereTool{4e-3}, open_options());
  ToolState state;
  double force = 0.0;
  for (int t = 0; t < 400; ++t) {
    state.time += 1e-3;
    state.position = {0.5 * side, 0.5 * side, 9e-3 + 1e-3 - std::min(1.0, t / 200.0) * (depth + 1e-3)};
    force = servo.tick(state).force()[2];
    if (status != nullptr && t >= 300) *status |= servo.tick_view().tissue_status(1);
    between(t);
  }
  return force;
}

/// Steps and solutions as a worker makes them, beside ticks at 1 kHz.
struct Beside {
  TouchingTissues& tissues;
  double due = 0.0;
  void operator()(int) {
    for (due -= 1e-3; due <= 0.0;) due += tissues.background_work().next;
  }
};

template <class Tissue>
int nearest_vertex(const Tissue& tissue, const Vector3& p) {
  const ContactSurface& surface = tissue.contact_surface();
  const auto distance = [&](int v) { return (tissue.to_world() * surface.position(v) - p).norm(); };
  int nearest = 0;
  for (int v = 1; v < surface.vertex_count(); ++v)
    if (distance(v) < distance(nearest)) nearest = v;
  return nearest;
}

/// How deep a vertex of one tissue is in another one, as found last, in mean facets.
inline double deepest(TouchingTissues& tissues) {
  std::vector<ContactSurface> now;
  for (std::size_t k = 0; k < tissues.size(); ++k) {
    TouchingTissue& tissue = tissues.tissue(k);
    tissue.begin_tick();
    std::vector<Vector3> positions;
    for (int v = 0; v < tissue.contact_surface().vertex_count(); ++v)
      positions.push_back(tissue.to_world() * tissue.contact_surface().expected().position(v));
    now.emplace_back(std::move(positions), tissue.contact_surface().triangles());
  }
  double deepest = 0.0;
  for (const ContactSurface& other : now) {
    double length = 0.0;
    for (int t = 0; t < static_cast<int>(other.triangles().size()); ++t) length += other.facet_length(t);
    length /= static_cast<double>(other.triangles().size());
    for (const ContactSurface& own : now)
      for (const Vector3& p : own.positions())
        if (&own != &other && other.bvh().bounds().squared_distance(p) == 0.0)
          deepest = std::max(deepest, -other.closest(p).distance / length);
  }
  return deepest;
}

inline Vector3 sum(std::span<const VertexForce> forces, const Eigen::Isometry3d& pose) {
  Vector3 all = Vector3::Zero();
  for (const VertexForce& f : forces) all += f.force.in_world(pose);
  return all;
}

struct SolutionCounts {
  int all = 0, flagged = 0;
};

/// Presses and drags a sphere of 4 mm on bodies of this radius, one on the other; finds the contact every 10 ticks. No
/// body enters another one by 3 % of a facet without a flag. `between` is called after every tick.
template <class Between>
void press_around(TouchingTissues& tissues, double r, Between between, SolutionCounts& counts) {
  HapticServo servo(tissues.group(), SphereTool{4e-3}, open_options());
  ToolState state;
  for (int t = 0; t < 400; ++t) {
    state.time += 1e-3;
    const double a = 2.0 * 3.14159265358979 * t / 400.0;
    state.position = {2e-3 * std::sin(2.0 * a), 2e-3 * std::sin(a), 3.0 * r + 5e-3 - 4e-3 * (1.0 - std::cos(a))};
    CHECK(servo.tick(state).force().allFinite());
    between(t);
    if (t % 10 != 9) continue;
    tissues.solve();
    ++counts.all;
    const Status status = tissues.report().status;
    if (!status.has(StatusFlag::lost_contact)) CHECK(deepest(tissues) < 0.03);
    counts.flagged += status.has(StatusFlag::lost_contact) || status.has(StatusFlag::solver_not_converged);
  }
}

}  // namespace touching_test
