// Repeated factorisation into the same memory.
#include <palpate/linear/repeated_cholesky.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "linear/sparse_cases.hpp"

using namespace test;

namespace {

/// The entry (j, j) of a lower half.
double& diagonal(SparseMatrix& lower, Index j) {
  return lower.coeffRef(j, j);
}

}  // namespace

TEST_CASE("a repeated factorisation equals a single one to the last bit", "[linear][repeated_cholesky]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const detail::CholeskyAnalysis analysis(c.lower, c.layout);
    detail::RepeatedCholesky repeated(analysis);
    CHECK_FALSE(repeated.ready());
    VectorX x(repeated.size());
    CHECK_FALSE(repeated.solve_into(x, x).converged);
    for (const double factor : {1.0, 3.0, 1.0}) {
      const SparseMatrix scaled = factor * c.lower;
      REQUIRE(repeated.factorise(scaled));
      SparseCholesky single(analysis, scaled, {});
      const VectorX b = random_vector(repeated.size(), 5);
      VectorX y(repeated.size());
      CHECK(repeated.solve_into(b, x).converged);
      single.solve_into(b, y);
      CHECK(x == y);
    }
  }
}

TEST_CASE("a repeated factorisation reports a failure and then accepts the next matrix",
          "[linear][repeated_cholesky]") {
  const SparseCase c = sphere_case(3);
  const detail::CholeskyAnalysis analysis(c.lower, c.layout);
  detail::RepeatedCholesky repeated(analysis);
  const Index last = c.lower.rows() - 1;
  for (const double bad : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), infinity}) {
    SparseMatrix broken = c.lower;
    diagonal(broken, last / 2) = bad;
    CHECK_FALSE(repeated.factorise(broken));
    CHECK_FALSE(repeated.ready());
    REQUIRE(repeated.factorise(c.lower));
    const VectorX b = random_vector(repeated.size(), 7);
    VectorX x(repeated.size()), y(repeated.size());
    repeated.solve_into(b, x);
    SparseCholesky(analysis, c.lower, {}).solve_into(b, y);
    CHECK(x == y);
  }
}

TEST_CASE("factorising again and solving do not allocate", "[linear][repeated_cholesky][allocation]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  const SparseCase c = sphere_case(3);
  detail::RepeatedCholesky repeated(detail::CholeskyAnalysis(c.lower, c.layout));
  VectorX x = random_vector(repeated.size(), 9);
  const testing::AllocationScope scope;
  const bool factorised = repeated.factorise(c.lower);
  repeated.solve_into(x, x);
  const std::uint64_t allocations = scope.allocations();
  CHECK(factorised);
  CHECK(allocations == 0);
}

TEST_CASE("a factor read in single precision is a preconditioner", "[linear][repeated_cholesky]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const detail::CholeskyAnalysis analysis(c.lower, c.layout);
    detail::RepeatedCholesky exact(analysis), single(analysis, {}, detail::FactorScalar::single_precision);
    CHECK(single.bytes() > exact.bytes());
    REQUIRE(exact.factorise(c.lower));
    REQUIRE(single.factorise(c.lower));
    VectorX x(exact.size()), y(exact.size());
    for (const double size : {1.0, 1e-60, 1e60}) {  // beyond the range of single precision
      const VectorX b = size * random_vector(exact.size(), 5);
      exact.solve_into(b, x);
      const testing::AllocationScope scope;
      single.solve_into(b, y);
      CHECK(scope.allocations() == 0);
      CHECK((x - y).norm() <= 1e-3 * x.norm());
    }
    // one refinement with it gains digits
    const VectorX b = random_vector(exact.size(), 5);
    exact.solve_into(b, x);
    single.solve_into(b, y);
    VectorX left = b - SparseMatrix(c.lower.selfadjointView<Eigen::Lower>()) * y, more(y.size());
    const double before = (x - y).norm();
    single.solve_into(left, more);
    y += more;
    CHECK((x - y).norm() <= 0.01 * before + 1e-12 * x.norm());
  }
}
