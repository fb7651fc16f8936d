// Complete motions: real-time ratio, drift and randomly displaced blocks.
#include <Eigen/Geometry>

#include "explicit.hpp"

namespace explicit_path {
namespace {

Vector3 swirl(const Vector3& p) {
  const Vector3 r = p - Vector3(0.05, 0.05, 0.05);
  return Vector3(0.2, -0.1, 0.3) + Vector3(4.0, -3.0, 5.0).cross(r) + 6.0 * Vector3(r.y(), r.z(), -r.x());
}
VectorX swirl_of(const Mesh<Tet4>& mesh) {
  VectorX v(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) v.segment<3>(3 * i) = swirl(mesh.position(i));
  return v;
}

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};
Momenta momenta(const Mesh<Tet4>& mesh, const MotionState& s) {
  Momenta m;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vector3 p = s.mass[3 * i] * s.velocity.segment<3>(3 * i);
    m.linear += p;
    m.angular += (mesh.position(i) + s.displacement.segment<3>(3 * i)).cross(p);
  }
  return m;
}

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

/// Processor time per simulated second, and the final displacement. Chooses `dt` when it is 0.
template <class S>
std::pair<double, VectorX> run(const HyperelasticBody<Tet4, NeoHookean>& body, double simulated, double& dt) {
  ExplicitOptions options;
  options.damping = 5.0;
  auto motion = motion_of<CentralDifference, S>(body, 1e-9, options);
  motion.estimate_limit(40);
  if (dt == 0.0) dt = 0.9 * motion.limit();
  for (Index i = 0; i < motion.state().mass.size(); i += 3) motion.load()[i] = 2.0 * motion.state().mass[i];
  Status status;
  const double spent = bench::seconds_of([&] {
    while (motion.state().time < simulated && status.ok()) status |= motion.step(dt);
  });
  return {status.ok() ? spent / motion.state().time : bench::unknown, motion.state().displacement};
}

}  // namespace

void measure_real_time(bench::RowFile& rows, int n) {
  const auto body = soft_block(n);
  double dt = 0.0;
  std::vector<double> in_double, in_float;
  double error = 0.0;
  for (int round = 0; round < 3; ++round) {
    const auto [time, u] = run<double>(body, 1.0, dt);
    const auto [float_time, float_u] = run<float>(body, 1.0, dt);
    in_double.push_back(time);
    in_float.push_back(float_time);
    error = (u - float_u).norm() / u.norm();
  }
  const auto add = [&](const std::vector<double>& times, const char* scalar, const std::string& more) {
    const double time = bench::percentile(times, 0.5);
    rows.add({.target = "m",
              .what = std::string("one second of an oscillating block, ") + scalar + ", " +
                      std::to_string(body.rest.mesh.element_count()) +
                      " tets, including the energy check and the limit",
              .figure = bench::milliseconds(time) + more,
              .baseline = "1000 ms; dt " + bench::milliseconds(dt),
              .ratio = 1.0 / time,
              .bound = bench::at_least(1.0),
              .error = std::isfinite(time) && error < 1e-2 ? "" : "stopped, or float and double differ"});
  };
  add(in_double, "double", "");
  add(in_float, "float", text_of(", final relative difference to double %.1e", error));
}

void measure_drift(bench::RowFile& rows) {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  ExplicitOptions options;
  auto motion = motion_of<CentralDifference>(body, -1.0, options);
  motion.set(VectorX::Zero(3 * mesh.node_count()), swirl_of(mesh));
  const Momenta before = momenta(mesh, motion.state());
  const double energy = motion.kinetic_energy() + motion.stored_energy(), dt = 0.25 * motion.limit();
  constexpr int parts = 10, steps = 1000000;
  double swing = 0.0, first = 0.0, last = 0.0;
  Status status;
  for (int part = 0; part < parts; ++part) {
    double mean = 0.0;
    for (int i = 0; i < steps / parts; ++i) {
      status |= motion.step(dt);
      const double now = motion.kinetic_energy() + motion.stored_energy();
      mean += now * parts / steps;
      swing = std::max(swing, std::abs(now / energy - 1.0));
    }
    (part == 0 ? first : last) = mean;
  }
  const Momenta after = momenta(mesh, motion.state());
  const double linear = (after.linear - before.linear).norm() / before.linear.norm(),
               angular = (after.angular - before.angular).norm() / before.angular.norm();
  rows.add({.target = "m",
            .what = "a free block over 1 000 000 steps: momentum, angular momentum",
            .figure = text_of("relative errors %.1e, %.1e", linear, angular),
            .baseline = "",
            .bound = {},
            .error = status.ok() && linear < 1e-10 && angular < 1e-8 ? "" : "not conserved, or a step was refused"});
  rows.add({.target = "m",
            .what = "its energy: largest fluctuation, drift of the mean from the first tenth to the last",
            .figure = text_of("%.1e, %.1e", swing, last / first - 1.0),
            .baseline = "",
            .bound = {},
            .error = swing < 0.02 && std::abs(last / first - 1.0) < 1e-3 ? "" : "not conserved"});
}

void measure_scrambles(bench::RowFile& rows, int runs) {
  const auto body = soft_block(2);
  const Index dofs = 3 * body.rest.mesh.node_count();
  ExplicitOptions options;
  options.damping = 60.0;
  options.limit_every = 1;
  options.margin = 0.15;
  auto motion = motion_of<CentralDifference>(body, 1e-9, options);
  testing::Random random(23);
  const double still = 1e-14;  // [J]
  for (const double amount : {0.02, 0.05}) {
    int inverted = 0, at_rest = 0, in_rest_shape = 0, stopped = 0, undetected = 0;
    for (int run = 0; run < runs; ++run) {
      VectorX u = VectorX::Zero(dofs);
      for (Index dof : motion.state().free) u[dof] = random.uniform(-amount, amount);
      motion.set(u, VectorX::Zero(dofs));
      inverted += motion.deformation().inverted > 0 ? 1 : 0;
      motion.estimate_limit(10);
      Status status;
      for (int i = 0; i < 6000 && (i < 100 || motion.kinetic_energy() > still); ++i)
        status |= motion.step(0.5 * motion.limit());
      const bool was_stopped = status.has(StatusFlag::energy_grew) || status.has(StatusFlag::step_refused);
      const bool rests = motion.state().displacement.allFinite() && motion.kinetic_energy() <= still &&
                         motion.deformation().inverted == 0;
      stopped += was_stopped ? 1 : 0;
      at_rest += rests ? 1 : 0;
      undetected += !rests && !was_stopped ? 1 : 0;
      in_rest_shape += motion.state().displacement.norm() < 1e-3 ? 1 : 0;
    }
    const double share = 1.0 / runs;
    const bool small = amount < 0.45 * 0.05;  // relative to a cell: then the rest shape is the only equilibrium
    std::string wrong;
    if (inverted * 8 < runs) wrong = "too few had inverted elements at the start";
    if (in_rest_shape < (small ? runs : runs / 2))
      wrong = "not in the rest shape at the end: " + std::to_string(runs - in_rest_shape);
    if (stopped > (small ? 0 : runs / 50)) wrong = "stopped by the energy check: " + std::to_string(stopped);
    if (undetected > 0) wrong = "neither at rest without inversion nor stopped: " + std::to_string(undetected);
    rows.add({.target = "m",
              .what = std::to_string(runs) + " blocks with nodes displaced at random by up to " +
                      bench::with_unit(1e3 * amount, "mm") +
                      " (cells of 50 mm): inverted at the start, at rest without inversion at the end, in the rest "
                      "shape, stopped",
              .figure = text_of("%.4f, %.4f, %.4f", inverted * share, at_rest * share, in_rest_shape * share) +
                        text_of(", %.4f", stopped * share),
              .baseline = "",
              .ratio = at_rest * share,
              .bound = bench::at_least(0.999),
              .error = wrong});
  }
}

}  // namespace explicit_path
