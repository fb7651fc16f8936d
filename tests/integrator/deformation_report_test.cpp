// Status flags and reports of explicit motion and its forces, and refused arguments.
#include <palpate/assembly/large_strain.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>

#include "integrator/motions.hpp"

using namespace test;

namespace {

/// x -> diag(scale) x.
VectorX stretched(const Mesh<Tet4>& mesh, const Vector3& scale) {
  return velocity_field(mesh, [&](const Vector3& p) -> Vector3 { return (scale - Vector3::Ones()).cwiseProduct(p); });
}

template <class Force>
DeformationReport report_of(const HyperelasticBody<Tet4, typename Force::Material>& body, const VectorX& u) {
  Force force(body);
  VectorX f(u.size());
  return force.force(u, f);
}

/// One node displaced far through the body.
VectorX pushed_through(const Mesh<Tet4>& mesh) {
  VectorX u = VectorX::Zero(3 * mesh.node_count());
  u[3 * Index{mesh.element_node(0, 0)} + 2] = 0.15;
  return u;
}

}  // namespace

TEMPLATE_TEST_CASE("the smallest volume ratio ignores lanes without an element", "[integrator][report]",
                   (BatchedTetrahedra<NeoHookean>), (BatchedTetrahedra<NeoHookean, float>)) {
  for (const int n : {1, 2, 3}) {  // 6, 48 and 162 elements: batches with and without empty lanes
    const auto body = soft_block(n);
    const DeformationReport grown = report_of<TestType>(body, stretched(body.rest.mesh, {1.2, 1.0, 1.0}));
    INFO(n << " cells: " << grown.smallest_volume_ratio);
    CHECK(std::abs(grown.smallest_volume_ratio - 1.2) <= 1e-5);
    CHECK(grown.worst_element >= 0);
    CHECK(grown.inverted == 0);
    const VectorX u = pushed_through(body.rest.mesh);
    const DeformationReport wrong = report_of<TestType>(body, u);
    VectorX f(u.size());
    const DeformationReport exact = LargeStrain<Tet4, NeoHookean>(body).force(u, f);
    CHECK(exact.inverted > 0);
    CHECK(wrong.inverted == exact.inverted);
    CHECK(std::abs(wrong.smallest_volume_ratio - exact.smallest_volume_ratio) <= 1e-5);
    CHECK(wrong.admissible);
  }
}

TEST_CASE("a step reports inverted elements and inadmissible materials", "[integrator][report]") {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  auto motion = motion_of<CentralDifference>(body, above_ground(mesh));
  CHECK(motion.step(0.1 * motion.limit()).ok());
  CHECK(motion.deformation().inverted == 0);
  const VectorX u = pushed_through(mesh), still = VectorX::Zero(u.size());
  motion.set(u, still);
  CHECK(motion.deformation().inverted > 0);
  motion.estimate_limit(40);
  const Status status = motion.step(1e-3 * motion.limit());
  CHECK(status == Status(StatusFlag::inverted));
  CHECK(motion.deformation().inverted > 0);
  CHECK(motion.deformation().smallest_volume_ratio < 0.0);
  motion.set(still, still);
  CHECK(motion.step(0.1 * motion.limit()).ok());

  const StVenantKirchhoff strict{3e3, 0.4, 1e3};
  const auto strict_body = make_hyperelastic_body(mesh, std::vector<StVenantKirchhoff>{strict});
  ExplicitMotion<BatchedTetrahedra<StVenantKirchhoff>, CentralDifference> other(
      BatchedTetrahedra<StVenantKirchhoff>(strict_body), lumped_mass(strict_body.rest), above_ground(mesh));
  other.set(u, still);
  other.estimate_limit(40);
  const Status worse = other.step(1e-3 * other.limit());
  CHECK(worse.has(StatusFlag::inverted));
  CHECK(worse.has(StatusFlag::degraded_model));
}

TEST_CASE("vectors of the wrong size are refused without a change", "[integrator][extremes]") {
  const auto body = soft_block(2);
  const Mesh<Tet4>& mesh = body.rest.mesh;
  auto motion = motion_of<CentralDifference>(body, above_ground(mesh));
  motion.load().setConstant(1e-4);
  CHECK(motion.step(0.1 * motion.limit()).ok());
  const MotionState before = motion.state();
  const VectorX full = VectorX::Zero(3 * mesh.node_count()), part = VectorX::Zero(mesh.node_count());
  CHECK_REFUSED(SetupErrorKind::bad_argument, motion.set(part, full));
  CHECK_REFUSED(SetupErrorKind::bad_argument, motion.set(full, part));
  CHECK(motion.state().displacement == before.displacement);
  CHECK(motion.state().velocity == before.velocity);
  for (VectorX* vector : {&motion.load(), &motion.target()}) {
    const VectorX kept = *vector;
    *vector = part;
    CHECK(motion.step(0.1 * motion.limit()).has(StatusFlag::step_refused));
    CHECK(motion.state().displacement == before.displacement);
    CHECK(motion.state().time == before.time);
    *vector = kept;
  }
  CHECK(motion.step(0.1 * motion.limit()).ok());
}

TEST_CASE("the bound limits the step until the estimate has settled", "[integrator]") {
  const auto body = soft_block(3);
  const std::vector<Index> free = all_dofs(body.rest.mesh);
  const double bound = element_frequency_bound(body.rest), of_bound = (1.0 - 0.07) * 2.0 / std::sqrt(bound);
  ExplicitOptions options;
  options.first_iterations = 0;
  auto motion = motion_of<CentralDifference>(body, free, options);
  CHECK(std::abs(motion.limit() / of_bound - 1.0) <= 1e-12);
  motion.estimate_limit(1);  // from a random start, far from the highest frequency
  CHECK(motion.limit() <= (1.0 + 1e-12) * of_bound);
  motion.estimate_limit(detail::StepLimit::trusted_iterations);
  CHECK(motion.limit() > 1.01 * of_bound);

  const auto with = [&](double given, int iterations) {
    ExplicitOptions o;
    o.first_iterations = iterations;
    NeoHookeanMotion<CentralDifference>(BatchedTetrahedra<NeoHookean>(body), lumped_mass(body.rest), free, given, o);
  };
  CHECK_REFUSED(SetupErrorKind::bad_argument, with(infinity, 3));
  CHECK_REFUSED(SetupErrorKind::bad_argument, with(std::nan(""), 40));
  CHECK_REFUSED(SetupErrorKind::bad_argument, with(-1.0, 40));
  with(infinity, detail::StepLimit::trusted_iterations);
  with(bound, 3);
}
