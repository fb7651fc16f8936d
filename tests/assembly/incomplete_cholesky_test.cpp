// The incomplete factorisation as a preconditioner of the free stiffness.
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "assembly/bodies.hpp"
#include "refused.hpp"

using namespace test;

namespace {

struct FixedBody {
  BlockMatrix k;
  EssentialConditions conditions;

  FixedBody(const Mesh<Tet4>& mesh, const LinearElastic& material)
      : k(assemble_stiffness<Tet4>(body_of(mesh, {material}), {})),
        conditions(conditions_of(mesh, Scene().fix("x0"))) {}
};

VectorX random_load(Index n, std::uint64_t seed) {
  testing::Random random(seed);
  return VectorX::NullaryExpr(n, [&] { return random.uniform(-1.0, 1.0); });
}

LinearElastic nearly(double poisson_ratio) {
  LinearElastic material = liver;
  material.poisson_ratio = poisson_ratio;
  return material;
}

int iterations(const detail::FreeStiffness& op, double tolerance = 1e-10) {
  detail::ConjugateGradientSolver solver(op.size(), {tolerance, 0});
  VectorX x(op.size());
  const SolveReport report = solver.solve_into(op, random_load(op.size(), 5), x);
  CHECK(report.converged);
  return report.iterations;
}

}  // namespace

TEST_CASE("the incomplete factorisation is exact when the elimination has no fill", "[assembly][preconditioner]") {
  // Neighbours of a node that come later share an element with it.
  Mesh<Tet4> helix;
  for (int i = 0; i < 12; ++i) helix.positions.emplace_back(std::cos(2.3 * i), std::sin(2.3 * i), 0.3 * i);
  for (NodeId i = 0; i + 3 < 12; ++i) helix.elements.push_back({i, i + 1, i + 2, i + 3});
  if (!detail::is_positively_oriented<Tet4>(element_nodes<Tet4>(helix, 0)))
    for (auto& nodes : helix.elements) std::swap(nodes[2], nodes[3]);
  const BlockMatrix k = assemble_stiffness<Tet4>(body_of(helix, {liver}), {});
  const EssentialConditions conditions = conditions_of(helix, Scene().fix(std::vector<NodeId>{5, 6, 7}));
  const detail::FreeStiffness op(k, conditions, {});
  const VectorX x = random_load(op.size(), 3);
  VectorX load(op.size()), found(op.size());
  op.apply(x, load);
  op.precondition(load, found);
  CHECK((found - x).norm() <= 1e-4 * x.norm());  // L is stored in single precision
}

TEST_CASE("the incomplete factorisation is symmetric and positive definite", "[assembly][preconditioner]") {
  for (const double nu : {-0.9, 0.0, 0.45, 0.4999, 0.5 * (1.0 - 1e-10)}) {
    const FixedBody body(box_tet4({0.2, 0.1, 0.1}, {4, 3, 3}, BoxSplit::six), nearly(nu));
    const detail::FreeStiffness op(body.k, body.conditions, {});
    VectorX pa(op.size()), pb(op.size());
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const VectorX a = random_load(op.size(), seed), b = random_load(op.size(), seed + 100);
      op.precondition(a, pa);
      op.precondition(b, pb);
      CHECK(std::abs(a.dot(pb) - b.dot(pa)) <= 1e-9 * (a.norm() * pb.norm() + b.norm() * pa.norm()));
      CHECK(a.dot(pa) > 0.0);
    }
  }
}

TEST_CASE("the incomplete factorisation saves iterations", "[assembly][preconditioner]") {
  const FixedBody body(box_tet4({0.2, 0.1, 0.1}, {12, 6, 6}, BoxSplit::six), nearly(0.3));
  const int blocks = iterations(detail::FreeStiffness(StiffnessView(body.k), body.conditions));
  const int incomplete = iterations(detail::FreeStiffness(body.k, body.conditions, {}));
  INFO(blocks << " iterations with diagonal blocks, " << incomplete << " with the incomplete factorisation");
  CHECK(2 * incomplete <= blocks);
}

TEST_CASE("a nearly incompressible body gets a shifted factorisation", "[assembly][preconditioner]") {
  const Mesh<Tet4> mesh = box_tet4({0.2, 0.1, 0.1}, {4, 3, 3}, BoxSplit::six);
  const FixedBody soft(mesh, nearly(0.3)), hard(mesh, nearly(0.4999));
  CHECK(detail::IncompleteCholesky(soft.k, soft.conditions, {}).shift() == 0.0);
  CHECK(detail::IncompleteCholesky(hard.k, hard.conditions, {}).shift() > 0.0);
  iterations(detail::FreeStiffness(hard.k, hard.conditions, {}));
}

TEST_CASE("prescribed components are left alone", "[assembly][preconditioner]") {
  const Mesh<Tet4> mesh = box_tet4({0.2, 0.1, 0.1}, {3, 2, 2}, BoxSplit::six);
  const BlockMatrix k = assemble_stiffness<Tet4>(body_of(mesh, {liver}), {});
  const EssentialConditions conditions = conditions_of(mesh, Scene().fix("x0").prescribe("x1", {1e-3, {}, {}}));
  const detail::IncompleteCholesky factor(k, conditions, {});
  VectorX r = random_load(k.size(), 9), z(k.size());
  factor.solve_into(r, z);
  for (Index dof = 0; dof < k.size(); ++dof)
    if (conditions.is_constrained(dof)) CHECK(std::abs(z[dof] - r[dof]) <= 1e-14);
}

TEST_CASE("a matrix that is not positive definite has no incomplete factorisation", "[assembly][preconditioner]") {
  FixedBody body(box_tet4({0.2, 0.1, 0.1}, {2, 1, 1}, BoxSplit::six), liver);
  for (const double bad : {-1.0, std::nan("")}) {
    FixedBody changed = body;
    changed.k.block(changed.k.pattern().diagonal(changed.k.pattern().rows() - 1))(1, 1) = bad;
    CHECK_REFUSED(SetupErrorKind::not_positive_definite, detail::IncompleteCholesky(changed.k, changed.conditions, {}));
  }
  SetupLimits limits;
  limits.memory = 100;
  CHECK_REFUSED(SetupErrorKind::too_large, detail::IncompleteCholesky(body.k, body.conditions, limits));
  limits = {};
  limits.progress = [](const Progress&) { return false; };
  CHECK_REFUSED(SetupErrorKind::cancelled, detail::IncompleteCholesky(body.k, body.conditions, limits));
}

TEST_CASE("preconditioning does not allocate", "[assembly][preconditioner]") {
  const FixedBody body(box_tet4({0.2, 0.1, 0.1}, {4, 2, 2}, BoxSplit::six), liver);
  const detail::FreeStiffness op(body.k, body.conditions, {});
  const VectorX r = random_load(op.size(), 4);
  VectorX z(op.size());
  const testing::AllocationScope scope;
  op.precondition(r, z);
  CHECK(scope.allocations() == 0);
}
