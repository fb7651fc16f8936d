// Matrices that the direct solver must refuse, with the ids of the bad dofs.
#include <palpate/linear/sparse_cholesky.hpp>

#include "linear/sparse_cases.hpp"

using namespace test;

namespace {

SetupProblem problem_of(const SparseMatrix& lower) {
  const SetupProblem p = refusal([&] { SparseCholesky(lower, {}); });
  CHECK(p.kind == SetupErrorKind::not_positive_definite);
  CHECK(p.count > 0);
  CHECK(p.ids.size() == static_cast<std::size_t>(std::min<std::int64_t>(p.count, SetupProblem::max_ids)));
  for (std::int64_t id : p.ids) CHECK((id >= 0 && id < lower.rows()));
  return p;
}

SparseMatrix free_sphere(int refinement) {
  const Body<Tet4> body = body_of(sphere_tet4(0.05, refinement), {liver});
  return free_matrix(assemble_stiffness<Tet4>(body, {}), conditions_of(body.mesh, Scene()));
}

}  // namespace

TEST_CASE("sparse Cholesky: NaN and infinity are refused wherever they are", "[linear][sparse_cholesky][extreme]") {
  const SparseMatrix good = sphere_stiffness(3);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity})
    for (Index at : {Index{0}, good.nonZeros() / 3, good.nonZeros() / 2, good.nonZeros() - 1}) {
      SparseMatrix m = good;
      m.valuePtr()[at] = bad;
      problem_of(m);
    }
}

TEST_CASE("sparse Cholesky: indefinite and negative matrices are refused", "[linear][sparse_cholesky][extreme]") {
  CHECK(problem_of(sphere_stiffness(3, {5e3, 0.6, 0.0})).value < 0.0);
  CHECK(problem_of(SparseMatrix(-sphere_stiffness(2))).value <= 0.0);
  SparseMatrix m = sphere_stiffness(2);
  m.coeffRef(31, 31) = -1.0;
  const SetupProblem p = problem_of(m);
  CHECK(p.value < 0.0);
}

TEST_CASE("sparse Cholesky: a single bad dof is reported", "[linear][sparse_cholesky][extreme]") {
  MatrixX m = MatrixX::Identity(30, 30);
  m(17, 17) = 0.0;
  const SetupProblem p = problem_of(lower_half(m));
  CHECK(p.count == 1);
  REQUIRE(p.ids.size() == 1);
  CHECK(p.ids[0] == 17);
  SparseMatrix missing(5, 5);  // no entry at all, not even a zero
  for (Index i : {0, 1, 3, 4}) missing.insert(i, i) = 1.0;
  missing.makeCompressed();
  CHECK(problem_of(missing).ids == std::vector<std::int64_t>{2});
}

TEST_CASE("sparse Cholesky: bad dofs are reported by their nodes when these are known",
          "[linear][sparse_cholesky][extreme]") {
  MatrixX m = MatrixX::Identity(30, 30);
  m(17, 17) = m(16, 16) = m(3, 3) = 0.0;
  DofLayout layout;
  for (Index dof = 0; dof < 30; ++dof) layout.node_of_dof.push_back(100 + dof / 3);
  const SparseMatrix lower = lower_half(m);
  const SetupProblem p = refusal([&] { SparseCholesky(detail::CholeskyAnalysis(lower, layout), lower, {}); });
  CHECK(p.kind == SetupErrorKind::not_positive_definite);
  CHECK(p.ids == std::vector<std::int64_t>{101, 105});
  CHECK(p.count == 2);
}

TEST_CASE("sparse Cholesky: a free body is refused, at any size and in any unit",
          "[linear][sparse_cholesky][extreme]") {
  for (int refinement : {1, 2, 4, 7})
    for (double unit : {1e-9, 1.0, 1e9}) {
      INFO(refinement << " " << unit);
      problem_of(SparseMatrix(unit * free_sphere(refinement)));
    }
}

TEST_CASE("sparse Cholesky: a barely definite matrix is accepted", "[linear][sparse_cholesky][extreme]") {
  const MatrixX m = with_condition(40, 1e12);
  VectorX x(40);
  SparseCholesky solver(lower_half(m), {});
  solver.solve_into(m * VectorX::Ones(40), x);
  CHECK((x - VectorX::Ones(40)).norm() <= 1e-2);
}

TEST_CASE("sparse Cholesky: a refusal leaves no state behind", "[linear][sparse_cholesky]") {
  const SparseMatrix good = sphere_stiffness(2);
  SparseMatrix bad = good;
  bad.coeffRef(4, 4) = -1.0;
  SparseCholesky solver(good, {});
  VectorX before(good.rows()), after(good.rows());
  const VectorX b = VectorX::Ones(good.rows());
  solver.solve_into(b, before);
  CHECK_REFUSED(SetupErrorKind::not_positive_definite, solver = SparseCholesky(solver.analysis(), bad, {}));
  solver.solve_into(b, after);
  CHECK(before == after);
}
