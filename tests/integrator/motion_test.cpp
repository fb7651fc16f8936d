// Explicit motion of a neo-Hookean block: conservation, refused arguments, extreme states.
#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/assembly/large_strain.hpp>

#include <Eigen/Geometry>
#include "integrator/motions.hpp"

using namespace test;

namespace {

Vector3 swirl(const Vector3& p) {
  const Vector3 r = p - Vector3(0.05, 0.05, 0.05);
  return Vector3(0.2, -0.1, 0.3) + Vector3(4.0, -3.0, 5.0).cross(r) + 6.0 * Vector3(r.y(), r.z(), -r.x());
}

/// True if the fastest mode grows at this step, which changes sign at every step. (A compressed block may also buckle,
/// which grows without changing sign, at any step.)
template <class Scheme>
bool unstable(const HyperelasticBody<Tet4, NeoHookean>& body, const VectorX& shape, const std::vector<Index>& free,
              double dt) {
  BatchedTetrahedra<NeoHookean> force(body);
  const VectorX mass = lumped_mass(body.rest).replicate(1, 3).transpose().reshaped();
  // the tangent at `shape` from differences; linear, so that stiffening does not limit the growth
  VectorX f0(shape.size()), f(shape.size()), moved(shape.size());
  force.force(shape, f0);
  testing::Random random(4);
  MotionState s;
  s.displacement = s.velocity = s.force = s.load = s.target = VectorX::Zero(shape.size());
  s.mass = mass;
  s.inverse_mass = VectorX::Zero(shape.size());
  for (Index dof : free) s.inverse_mass[dof] = 1.0 / mass[dof];
  for (Index dof : free) s.displacement[dof] = random.uniform(-1.0, 1.0);
  const double probe = force.probe_length();
  const auto refresh = [&]() noexcept {
    const double scale = probe / s.displacement.cwiseAbs().maxCoeff();
    moved = shape + scale * s.displacement;
    force.force(moved, f);
    s.force = (f - f0) / scale;
  };
  refresh();
  const double start = s.displacement.norm();
  VectorX before;
  for (int i = 0; i < 150; ++i) {
    before = s.displacement;
    Scheme::step(s, dt, refresh);
  }
  const double size = s.displacement.norm();
  REQUIRE(std::isfinite(size));
  return size > 1e3 * start && s.displacement.dot(before) / size / before.norm() < -0.5;
}

template <class Scheme>
double measured_limit(const HyperelasticBody<Tet4, NeoHookean>& body, const VectorX& shape,
                      const std::vector<Index>& free, double guess) {
  double low = 0.7 * guess, high = 1.3 * guess;
  REQUIRE_FALSE(unstable<Scheme>(body, shape, free, low));
  REQUIRE(unstable<Scheme>(body, shape, free, high));
  while (high - low > 0.005 * guess) {
    const double middle = 0.5 * (low + high);
    (unstable<Scheme>(body, shape, free, middle) ? high : low) = middle;
  }
  return low;
}

/// Compressed to a fraction of its height, and widened so that its volume is constant.
VectorX pressed(const Mesh<Tet4>& mesh, double ratio) {
  const double wider = 1.0 / std::sqrt(ratio) - 1.0;
  return velocity_field(mesh, [&](const Vector3& p) -> Vector3 {
    return {wider * p.x(), wider * p.y(), (ratio - 1.0) * p.z()};
  });
}

}  // namespace

TEMPLATE_TEST_CASE("free flight conserves momentum, and its energy oscillates about the mean", "[integrator]",
                   CentralDifference, SemiImplicitEuler) {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  auto motion = motion_of<TestType>(body, all_dofs(mesh));
  motion.set(VectorX::Zero(3 * mesh.node_count()), velocity_field(mesh, swirl));
  const MotionState& s = motion.state();
  const Momenta start = momenta(mesh, s);
  const double energy = motion.kinetic_energy() + motion.stored_energy(), dt = 0.25 * motion.limit();
  double low = energy, high = energy, late_low = infinity, late_high = 0.0;
  const int steps = 100000;
  for (int i = 0; i < steps; ++i) {
    REQUIRE(motion.step(dt).ok());
    if (i % 7 != 0) continue;
    const double now = motion.kinetic_energy() + motion.stored_energy();
    (i < steps / 2 ? low : late_low) = std::min(i < steps / 2 ? low : late_low, now);
    (i < steps / 2 ? high : late_high) = std::max(i < steps / 2 ? high : late_high, now);
  }
  INFO(low / energy << ' ' << high / energy << ' ' << late_low / energy << ' ' << late_high / energy);
  const Momenta end = momenta(mesh, s);
  CHECK((end.linear - start.linear).norm() <= 1e-12 * start.linear.norm());
  CHECK((end.angular - start.angular).norm() <= 1e-11 * start.angular.norm());
  const double swing = TestType::order == 2 ? 0.02 : 0.15;  // relative to the energy, for any duration
  CHECK(low >= (1.0 - swing) * energy);
  CHECK(high <= (1.0 + swing) * energy);
  CHECK(late_low >= (1.0 - swing) * energy);
  CHECK(late_high <= (1.0 + swing) * energy);
}

TEST_CASE("free fall", "[integrator]") {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  auto motion = motion_of<CentralDifference>(body, all_dofs(mesh));
  const Vector3 g(0.0, 0.0, -9.81);
  motion.load() = motion.state().mass.cwiseProduct(velocity_field(mesh, [&](const Vector3&) { return g; }));
  const double dt = 0.5 * motion.limit();
  for (int i = 0; i < 2000; ++i) REQUIRE(motion.step(dt).ok());
  const double t = motion.state().time;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    CHECK((motion.state().displacement.segment<3>(3 * i) - 0.5 * t * t * g).norm() <= 1e-11 * t * t);
    CHECK((motion.state().velocity.segment<3>(3 * i) - t * g).norm() <= 1e-10 * t);
  }
}

TEMPLATE_TEST_CASE("the limit follows the state: within 5 % of the stability limit", "[integrator][extreme][E2]",
                   CentralDifference, SemiImplicitEuler) {
  const auto body = soft_block(3);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  const std::vector<Index> free = above_ground(mesh);
  ExplicitOptions options;
  options.margin = 0.03;
  auto motion = motion_of<TestType>(body, free, options);
  double at_rest = 0.0;
  for (const double ratio : {1.0, 0.5}) {
    const VectorX shape = pressed(mesh, ratio);
    motion.set(shape, VectorX::Zero(shape.size()));
    const double limit = motion.estimate_limit(60), measured = measured_limit<TestType>(body, shape, free, limit);
    INFO("pressed to " << ratio << ": limit " << limit << ", measured " << measured);
    CHECK(limit <= measured);
    CHECK(limit >= 0.95 * measured);
    CHECK(motion.step(1.001 * limit).has(StatusFlag::step_refused));
    CHECK(motion.step(0.999 * limit).ok());
    if (ratio == 1.0)
      at_rest = limit;
    else
      CHECK(limit < 0.85 * at_rest);
  }
}

TEST_CASE("the element bound is above the limit, and close", "[integrator]") {
  const auto body = soft_block(3);
  auto motion = motion_of<CentralDifference>(body, all_dofs(body.rest.mesh));
  ExplicitOptions options;
  options.first_iterations = 0;
  auto bounded = motion_of<CentralDifference>(body, all_dofs(body.rest.mesh), options);
  motion.estimate_limit(100);
  CHECK(bounded.limit() <= motion.limit());
  CHECK(bounded.limit() >= 0.5 * motion.limit());
}

TEST_CASE("invalid steps are refused without a change", "[integrator][extreme][E1]") {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  auto motion = motion_of<CentralDifference>(body, above_ground(mesh));
  motion.set(VectorX::Zero(3 * mesh.node_count()), velocity_field(mesh, swirl));
  for (int i = 0; i < 20; ++i) REQUIRE(motion.step(0.5 * motion.limit()).ok());
  const MotionState before = motion.state();
  for (const double dt : {0.0, -1e-4, std::nan(""), infinity, -infinity, 1.0, 10.0 * motion.limit()}) {
    CHECK(motion.step(dt).has(StatusFlag::step_refused));
    CHECK(motion.state().displacement == before.displacement);
    CHECK(motion.state().velocity == before.velocity);
    CHECK(motion.state().time == before.time);
    CHECK_REFUSED(SetupErrorKind::bad_argument, motion.require_step(dt));
  }
  CHECK(motion.step(1e-9).ok());
  CHECK((motion.state().displacement - before.displacement).norm() <= 1.1e-9 * before.velocity.norm());
  CHECK(motion.state().displacement != before.displacement);

  const BatchedTetrahedra<NeoHookean> force(body);
  using Motion = NeoHookeanMotion<CentralDifference>;
  VectorX mass = lumped_mass(body.rest);
  CHECK_REFUSED(SetupErrorKind::bad_argument, Motion(force, mass.head(3), {}));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, Motion(force, mass, {3 * mass.size()}));
  ExplicitOptions negative;
  negative.damping = -1.0;
  CHECK_REFUSED(SetupErrorKind::bad_argument, Motion(force, mass, {}, 1.0, negative));
  mass[4] = 0.0;
  CHECK_REFUSED(SetupErrorKind::bad_density, Motion(force, mass, {}));
}

TEST_CASE("an unexplained energy growth stops the motion at its last good state", "[integrator][extreme][E6]") {
  const auto body = soft_block(3);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  ExplicitOptions options;
  options.limit_every = 0;
  options.first_iterations = 0;
  // a bound that is far too low: only the energy check can detect it
  NeoHookeanMotion<CentralDifference> motion(BatchedTetrahedra<NeoHookean>(body), lumped_mass(body.rest),
                                             above_ground(mesh), 0.01 * element_frequency_bound(body.rest), options);
  const VectorX still = VectorX::Zero(3 * mesh.node_count());
  motion.set(still, velocity_field(mesh, swirl));
  const double energy = motion.kinetic_energy(), dt = motion.limit();
  int steps = 0;
  Status status;
  while (!(status = motion.step(dt)).has(StatusFlag::energy_grew) && steps < 100) ++steps;
  CHECK(steps <= 3);
  CHECK(status.has(StatusFlag::energy_grew));
  CHECK(motion.state().displacement.allFinite());
  CHECK(motion.kinetic_energy() + motion.stored_energy() <= 100.0 * energy);
  const VectorX stopped = motion.state().displacement;
  CHECK(motion.step(dt).has(StatusFlag::energy_grew));
  CHECK(motion.state().displacement == stopped);
  motion.set(still, still);
  CHECK(motion.step(1e-6).ok());

  motion.set(still, velocity_field(mesh, swirl));
  motion.load()[mesh.node_count()] = std::nan("");
  for (int i = 0; i < 3; ++i) status = motion.step(1e-6);
  CHECK(status.has(StatusFlag::energy_grew));
  CHECK(motion.state().displacement.allFinite());
}

TEST_CASE("a stopped motion continues after set(), with the limit of the new state", "[integrator][extreme][E2]") {
  const auto body = soft_block(3);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  const VectorX still = VectorX::Zero(3 * mesh.node_count());
  ExplicitOptions options;
  options.limit_every = 1;  // estimates in every state, non-finite ones included
  auto motion = motion_of<CentralDifference>(body, above_ground(mesh), options);
  const double at_rest = motion.limit();
  const VectorX load = motion.load();
  motion.load()[still.size() - 1] = std::nan("");
  Status status;
  for (int k = 0; k < 40 && !status.has(StatusFlag::energy_grew); ++k) status = motion.step(0.5 * at_rest);
  REQUIRE(status.has(StatusFlag::energy_grew));
  motion.load() = load;
  motion.restart();
  CHECK(motion.limit() >= 0.95 * at_rest);
  for (int k = 0; k < 20; ++k) REQUIRE(motion.step(0.5 * at_rest).ok());

  motion.set(pressed(mesh, 0.5), still);
  const double limit = motion.limit();
  CHECK(limit < 0.85 * at_rest);
  CHECK(limit <= 1.05 * motion.estimate_limit(200));
}

TEST_CASE("a motion after set() repeats bitwise, whatever was before", "[integrator]") {
  const auto body = test::soft_block(3);
  const auto& mesh = body.rest.mesh;
  auto motion = motion_of<SemiImplicitEuler>(body, above_ground(mesh));
  const VectorX still = VectorX::Zero(3 * mesh.node_count());
  const auto swing = [&] {
    motion.set(still, velocity_field(mesh, swirl));
    for (int k = 0; k < 200; ++k) motion.step(motion.limit());
    return VectorX(motion.state().displacement);
  };
  const VectorX first = swing();
  motion.set(pressed(mesh, 0.5), still);
  CHECK(swing() == first);
}

TEST_CASE("the energy check of a linear body detects the first steps that are too long", "[integrator][extreme][E6]") {
  const auto body = make_body(box_tet4(Vector3(0.1, 0.1, 0.1), {3, 3, 3}), LinearElastic{3e3, 0.45, 1000.0});
  const Mesh<Tet4>& mesh = body.mesh;
  ExplicitOptions options;
  options.limit_every = 0;
  options.first_iterations = 0;
  ExplicitMotion<LinearForces, CentralDifference> motion(LinearForces(assemble_stiffness<Tet4>(body, {})),
                                                         lumped_mass(body), above_ground(mesh),
                                                         0.01 * element_frequency_bound(body), options);
  motion.set(VectorX::Zero(3 * mesh.node_count()), velocity_field(mesh, swirl));
  const double energy = motion.kinetic_energy();
  int steps = 0;
  while (!motion.step(motion.limit()).has(StatusFlag::energy_grew) && steps < 100) ++steps;
  CHECK(steps <= 3);
  CHECK(motion.kinetic_energy() + motion.stored_energy() <= 100.0 * energy);
}

TEST_CASE("explicit steps do not allocate", "[integrator][allocation]") {
  const auto body = soft_block(3);
  auto motion = motion_of<CentralDifference>(body, above_ground(body.rest.mesh));
  motion.load().setConstant(1e-4);
  const testing::AllocationScope scope;
  for (int k = 0; k < 40; ++k) motion.step(0.5 * motion.limit());
  motion.restart();
  CHECK(scope.allocations() == 0);
  CHECK(motion.state().time > 0.0);
}

TEST_CASE("randomly deformed blocks stay finite and come to rest", "[integrator][extreme][E5]") {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  ExplicitOptions options;
  options.damping = 60.0;
  options.limit_every = 1;  // the limit changes from step to step
  options.margin = 0.15;
  const std::vector<Index> free = above_ground(mesh);
  auto motion = motion_of<CentralDifference>(body, free, options);
  testing::Random random(17);
  // With displacements below half a cell every block returns to rest. With those of a whole cell, most elements are
  // inverted and some blocks find another equilibrium without inverted elements: a corner pushed through.
  const double cell = 0.05;
  for (const double amount : {0.45 * cell, cell}) {
    int inverted_at_start = 0, flagged = 0, missed = 0, at_rest = 0, upright = 0, home = 0;
    const int runs = 100;
    for (int run = 0; run < runs; ++run) {
      VectorX u = VectorX::Zero(3 * mesh.node_count());
      for (Index dof : free) u[dof] = random.uniform(-amount, amount);
      motion.set(u, VectorX::Zero(u.size()));
      inverted_at_start += motion.deformation().inverted > 0 ? 1 : 0;
      motion.estimate_limit(10);
      for (int i = 0; i < 6000 && (i < 100 || motion.kinetic_energy() > 1e-14); ++i) {
        const Status status = motion.step(0.5 * motion.limit());
        flagged += status.has(StatusFlag::step_refused) || status.has(StatusFlag::energy_grew) ? 1 : 0;
        missed += status.has(StatusFlag::inverted) != (motion.deformation().inverted > 0) ? 1 : 0;
      }
      REQUIRE(motion.state().displacement.allFinite());
      at_rest += motion.kinetic_energy() <= 1e-14 ? 1 : 0;
      upright += motion.deformation().inverted == 0 ? 1 : 0;
      home += motion.state().displacement.norm() < 1e-3 ? 1 : 0;
    }
    INFO("moved by up to " << amount << " m: " << home << " of " << runs << " returned to rest");
    CHECK(inverted_at_start > runs / 4);
    CHECK(flagged == 0);
    CHECK(missed == 0);
    CHECK(at_rest == runs);
    CHECK(upright == runs);
    CHECK(home >= (amount < cell ? runs : runs / 2));
  }
}
