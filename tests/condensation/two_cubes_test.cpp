// Condensation (thesis 3.7) against another code and against the full solve.
#include <palpate/assembly/load_vector.hpp>
#include <palpate/condensation/static_systems.hpp>
#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <palpate/testing/condensation_laws.hpp>

#include "assembly/csv.hpp"
#include "linear/systems.hpp"
#include "mesh/two_cubes.hpp"

#include <numeric>

using namespace test;

namespace {

/// A body, its conditions, and the free dofs of some nodes.
struct Problem {
  Body<Tet4> body;
  EssentialConditions conditions;
  SparseMatrix lower;
  std::vector<Index> kept;

  Problem(Mesh<Tet4> mesh, const LinearElastic& m, const Scene& scene, const std::vector<NodeId>& kept_nodes)
      : body(body_of(std::move(mesh), {m})),
        conditions(conditions_of(body.mesh, scene)),
        lower(free_matrix(assemble_stiffness<Tet4>(body, {}), conditions)) {
    for (NodeId node : kept_nodes)
      for (int c = 0; c < 3; ++c)
        if (const Index i = conditions.free_index[static_cast<std::size_t>(3 * node + c)]; i >= 0) kept.push_back(i);
  }
  VectorX free_part(const VectorX& f) const {
    VectorX part(conditions.free_count());
    conditions.gather(f, part);
    return part;
  }
};

Problem cubes() {
  return {two_cubes(), reference_material, Scene().fix("fixed"), {8, 9, 10, 11}};
}

/// A sphere fixed at its south pole, with the north kept: inner and other surface nodes are condensed.
Problem sphere() {
  const Mesh<Tet4> mesh = sphere_tet4(0.05, 3);
  std::vector<NodeId> south, north;
  for (NodeId i = 0; i < mesh.node_count(); ++i) {
    if (mesh.position(i)[2] < -0.04) south.push_back(i);
    if (mesh.position(i)[2] > 0.02 && mesh.position(i).norm() > 0.049) north.push_back(i);
  }
  return {mesh, liver, Scene().fix(south), north};
}

/// Displacement under gravity and initial strain, both acting on condensed dofs as well: full and condensed.
template <class Dense>
double gravity_and_strain_error(const Problem& p) {
  Body<Tet4> body = p.body;
  Vector6 strain;
  strain << 1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4;
  body.initial_strain.assign(body.initial_strain.size(), strain);
  const VectorX mass = nodal_mass(body);
  VectorX f = detail::initial_strain_load(body);
  for (Index i = 0; i < mass.size(); ++i) f.segment<3>(3 * i) += mass[i] * Vector3(1.0, -2.0, -9.81);
  const VectorX b = p.free_part(f), truth = exact_solution(full(p.lower), b);
  CondensedSystem system = CondensedSystem::with<Dense>(detail::condense(p.lower, p.kept, {}), {});
  VectorX x(b.size());
  system.solve_into(b, x);
  return (x - truth).norm() / truth.norm();
}

}  // namespace

TEST_CASE("two cubes condensed to nodes 9 to 12 equal the result of another code", "[condensation][oracle]") {
  const MatrixX reference = read_matrix(two_cubes_folder + "K_condensed_to_nodes_9_12.csv");
  REQUIRE(reference.rows() == 12);
  const Problem p = cubes();
  const detail::SchurComplement s = detail::condense(p.lower, p.kept, {});
  CHECK(s.interior.kept() == 12);
  CHECK(s.interior.size() == 24);
  CHECK(largest(s.stiffness - reference) <= 1e-12 * largest(reference));
  CHECK(s.stiffness == s.stiffness.transpose());
}

TEST_CASE("condensed systems equal the full solve", "[condensation][laws][M11]") {
  for (const Problem& p : {cubes(), sphere()}) {
    REQUIRE(p.kept.size() < static_cast<std::size_t>(p.lower.rows()));
    const detail::DenseOperator op(full(p.lower));
    CondensedSystem inverse = CondensedSystem::with<DenseInverse<double>>(detail::condense(p.lower, p.kept, {}), {});
    CHECK(testing::describe(testing::condensation_laws(op, inverse, p.kept)) == "");
    CondensedSystem cholesky = CondensedSystem::with<DenseCholesky>(detail::condense(p.lower, p.kept, {}), {});
    CHECK(testing::describe(testing::condensation_laws(op, cholesky, p.kept)) == "");
    CondensedSystem iterative =
        CondensedSystem::with<detail::DenseConjugateGradient>(detail::condense(p.lower, p.kept, {}), {});
    CHECK(testing::describe(testing::condensation_laws(op, iterative, p.kept, 1e-9)) == "");
    CondensedSystem single = CondensedSystem::with<DenseInverse<float>>(detail::condense(p.lower, p.kept, {}), {});
    CHECK(testing::describe(testing::condensation_laws(op, single, p.kept, 1e-4)) == "");
    Uncondensed none(SparseCholesky(p.lower, {}), p.kept);
    CHECK(testing::describe(testing::condensation_laws(op, none, p.kept)) == "");
  }
}

TEST_CASE("gravity and initial strain on condensed dofs are not lost", "[condensation]") {
  for (const Problem& p : {cubes(), sphere()}) {
    CHECK(gravity_and_strain_error<DenseCholesky>(p) <= 1e-12);
    CHECK(gravity_and_strain_error<DenseInverse<double>>(p) <= 1e-12);
    CHECK(gravity_and_strain_error<detail::DenseConjugateGradient>(p) <= 1e-9);
  }
}

TEST_CASE("condensation: any order, no kept dofs, all dofs kept", "[condensation]") {
  const Problem p = cubes();
  const detail::DenseOperator op(full(p.lower));
  SECTION("any order") {
    const std::vector<Index> kept{7, 0, 23, 12, 3};
    CondensedSystem system = CondensedSystem::with<DenseCholesky>(detail::condense(p.lower, kept, {}), {});
    CHECK(testing::describe(testing::condensation_laws(op, system, kept)) == "");
  }
  SECTION("no kept dofs") {
    const std::vector<Index> kept;
    CondensedSystem system = CondensedSystem::with<DenseCholesky>(detail::condense(p.lower, kept, {}), {});
    CHECK(system.kept() == 0);
    CHECK(testing::describe(testing::condensation_laws(op, system, kept)) == "");
  }
  SECTION("all dofs kept") {
    std::vector<Index> kept(static_cast<std::size_t>(p.lower.rows()));
    std::iota(kept.begin(), kept.end(), Index{0});
    const detail::SchurComplement s = detail::condense(p.lower, kept, {});
    CHECK(largest(s.stiffness - full(p.lower)) <= 1e-15 * largest(s.stiffness));
    CondensedSystem system = CondensedSystem::with<DenseCholesky>(s, {});
    CHECK(testing::describe(testing::condensation_laws(op, system, kept)) == "");
  }
}

TEST_CASE("condensing can be cancelled and is bounded in memory", "[condensation][extreme][B10]") {
  const Problem p = sphere();
  SetupLimits limits;
  limits.progress = [](const Progress& progress) { return progress.stage != "factorisation"; };
  CHECK_REFUSED(SetupErrorKind::cancelled, detail::condense(p.lower, p.kept, limits));
  SetupLimits small;
  small.memory = 1000;
  const SetupProblem problem = refusal([&] { detail::condense(p.lower, p.kept, small); });
  CHECK(to_string(problem.kind) == "too_large");
  const double k = static_cast<double>(p.kept.size());
  CHECK(problem.value >= 8.0 * k * k);
  CHECK(problem.threshold == 1000.0);
}

TEST_CASE("a condensed part that is not constrained is refused", "[condensation][extreme][B7]") {
  Problem p = cubes();
  // Once the fixed nodes are free as well, the rest is attached to kept node 8 at one point only.
  const EssentialConditions none = conditions_of(p.body.mesh, Scene());
  const SparseMatrix free = free_matrix(assemble_stiffness<Tet4>(p.body, {}), none);
  const std::vector<Index> kept{24, 25, 26};
  CHECK_REFUSED(SetupErrorKind::not_positive_definite, detail::condense(free, kept, {}));
  // Keeping three nodes moves the rigid motions into the condensed stiffness.
  std::vector<Index> more(12);
  std::iota(more.begin(), more.end(), Index{24});
  CHECK_REFUSED(SetupErrorKind::not_positive_definite,
                CondensedSystem::with<DenseCholesky>(detail::condense(free, more, {}), {}));
}
