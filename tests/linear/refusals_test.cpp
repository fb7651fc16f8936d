// Matrices without a trustworthy solution are refused, where Eigen reports success.
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <Eigen/SparseCholesky>
#include <cstdio>

#include "linear/systems.hpp"

using namespace test;

namespace {

/// Status reported by Eigen's own factorisations.
struct EigenStatus {
  Eigen::ComputationInfo sparse_ldlt, dense_llt, dense_ldlt;
};
EigenStatus eigen_status(const MatrixX& m) {
  const SparseMatrix lower = lower_half(m);
  return {Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>(lower).info(), Eigen::LLT<MatrixX>(m).info(),
          Eigen::LDLT<MatrixX>(m).info()};
}

void check_all_refuse(const MatrixX& m) {
  CHECK_REFUSED(SetupErrorKind::not_positive_definite, SparseCholesky(lower_half(m), {}));
  CHECK_REFUSED(SetupErrorKind::not_positive_definite, DenseCholesky(m, {}));
  CHECK_REFUSED(SetupErrorKind::not_positive_definite, DenseInverse<double>(m, {}));
  CHECK_REFUSED(SetupErrorKind::not_positive_definite, DenseInverse<float>(m, {}));
}

/// Stiffness of a free body: singular, six rigid motions.
MatrixX free_body() {
  const Body<Tet4> body = body_of(sphere_tet4(0.05, 2), {liver});
  return full(free_matrix(assemble_stiffness<Tet4>(body, {}), conditions_of(body.mesh, Scene())));
}

const MatrixX good = full(sphere_stiffness(2));

}  // namespace

TEST_CASE("NaN is refused, Eigen reports Success", "[linear][extreme][C3]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (Index at : {Index{0}, good.rows() / 2, good.rows() - 1}) {
    MatrixX m = good;
    m(at, at) = nan;
    const EigenStatus status = eigen_status(m);
    CHECK(status.sparse_ldlt == Eigen::Success);
    CHECK(status.dense_llt == Eigen::Success);
    check_all_refuse(m);
  }
  MatrixX m = good;
  m(20, 3) = m(3, 20) = nan;
  CHECK(eigen_status(m).sparse_ldlt == Eigen::Success);
  check_all_refuse(m);
}

TEST_CASE("infinity is refused", "[linear][extreme][C3]") {
  MatrixX m = good;
  m(7, 7) = infinity;
  check_all_refuse(m);
  m = good;
  m(9, 2) = m(2, 9) = infinity;
  check_all_refuse(m);
}

TEST_CASE("an indefinite matrix is refused, Eigen's LDLT reports Success", "[linear][extreme][A1]") {
  const MatrixX m = full(sphere_stiffness(2, {5e3, 0.6, 0.0}));  // Poisson ratio beyond one half
  CHECK(eigen_status(m).sparse_ldlt == Eigen::Success);
  CHECK(eigen_status(m).dense_ldlt == Eigen::Success);
  check_all_refuse(m);
  const SetupProblem p = refusal([&] { SparseCholesky(lower_half(m), {}); });
  CHECK(p.value < 0.0);
  CHECK(p.count > 0);
  CHECK(p.ids.size() <= SetupProblem::max_ids);
}

TEST_CASE("a negative definite matrix is refused, Eigen's LDLT reports Success", "[linear][extreme]") {
  CHECK(eigen_status(-good).sparse_ldlt == Eigen::Success);
  check_all_refuse(-good);
  MatrixX one(2, 2);  // a negative pivot on a negative diagonal
  one << 2, 0, 0, -3;
  CHECK(eigen_status(one).sparse_ldlt == Eigen::Success);
  check_all_refuse(one);
}

TEST_CASE("a free body is refused, Eigen's LDLT reports Success", "[linear][extreme][B7]") {
  const MatrixX m = free_body();
  CHECK(eigen_status(m).sparse_ldlt == Eigen::Success);
  check_all_refuse(m);
  check_all_refuse(1e-9 * m);
  check_all_refuse(1e9 * m);
}

TEST_CASE("a zero row is refused", "[linear][extreme][B6]") {
  MatrixX m = good;
  m.row(11).setZero();
  m.col(11).setZero();
  check_all_refuse(m);
  check_all_refuse(MatrixX::Zero(5, 5));
}

TEST_CASE("a singular matrix of small integers is refused, Eigen's dense LDLT reports Success", "[linear][extreme]") {
  MatrixX m(3, 3);
  m << 2, -1, -1, -1, 2, -1, -1, -1, 2;
  CHECK(eigen_status(m).dense_ldlt == Eigen::Success);
  check_all_refuse(m);
}

TEST_CASE("a barely definite matrix is accepted", "[linear][extreme]") {
  const MatrixX m = with_condition(40, 1e12);
  VectorX x(40);
  SparseCholesky sparse(lower_half(m), {});
  sparse.solve_into(m * VectorX::Ones(40), x);
  CHECK((x - VectorX::Ones(40)).norm() <= 1e-2);
  CHECK_NOTHROW(DenseCholesky(m, {}));
}

TEST_CASE("comparison with Eigen", "[.][table]") {
  MatrixX with_nan = good, with_infinity = good, zero_row = good;
  with_nan(20, 3) = with_nan(3, 20) = std::numeric_limits<double>::quiet_NaN();
  with_infinity(7, 7) = infinity;
  zero_row.row(11).setZero();
  zero_row.col(11).setZero();
  const std::vector<std::pair<const char*, MatrixX>> matrices{
      {"sphere, constrained", good},
      {"NaN in one entry", with_nan},
      {"infinity on the diagonal", with_infinity},
      {"Poisson ratio 0.6", full(sphere_stiffness(2, {5e3, 0.6, 0.0}))},
      {"negative definite", -good},
      {"free body", free_body()},
      {"one row zero", zero_row},
      {"condition 1e12", with_condition(40, 1e12)},
      {"condition 1e17", with_condition(40, 1e17)},
  };
  std::printf("%-26s %-12s %-12s %-22s %s\n", "matrix", "SimplicialLDLT", "dense LDLT", "error of its answer", "ours");
  for (const auto& [name, m] : matrices) {
    const EigenStatus status = eigen_status(m);
    const auto word = [](Eigen::ComputationInfo info) { return info == Eigen::Success ? "Success" : "no"; };
    const VectorX ones = VectorX::Ones(m.rows()), b = m * ones;
    const double error = (VectorX(Eigen::LDLT<MatrixX>(m).solve(b)) - ones).norm() / ones.norm();
    std::string ours = "accepted";
    try {
      SparseCholesky solver(lower_half(m), {});
      VectorX x(m.rows());
      solver.solve_into(b, x);
      ours += ", error " + number((x - ones).norm() / ones.norm());
    } catch (const SetupError& e) {
      ours = std::string(e.what()).substr(0, 90);
    }
    std::printf("%-26s %-12s %-12s %-22.3g %s\n", name, word(status.sparse_ldlt), word(status.dense_ldlt), error,
                ours.c_str());
  }
}
