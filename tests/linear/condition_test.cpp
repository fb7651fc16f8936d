// Accuracy of a solver for the softest motion.
#include <palpate/linear/condition.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

constexpr Index entries = 10'000, soft = 4711;

/// Ones on the diagonal, except for one entry near rounding.
struct SoftDiagonal {
  Index size() const noexcept { return entries; }
  void apply(const VectorX& x, VectorX& y) const noexcept {
    y = x;
    y[soft] *= 1e-14;
  }
  void precondition(const VectorX& x, VectorX& y) const noexcept { y = x; }
};
/// Solves for it, with an error by a factor of 3 in the soft entry, as rounding may cause for a mechanism.
struct SoftSolver {
  double factor = 3.0;
  Index size() const noexcept { return entries; }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    x = b;
    x[soft] *= 1e14 / factor;
    return {};
  }
};

/// The inverse of a symmetric matrix; counts the solves.
struct CountedSolver {
  MatrixX inverse;
  int solves = 0;
  Index size() const noexcept { return inverse.rows(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    ++solves;
    x = inverse * b;
    return {};
  }
};

double largest_column_sum(const MatrixX& m) {
  return m.cwiseAbs().colwise().sum().maxCoeff();
}

}  // namespace

TEST_CASE("the norm of an inverse is estimated from few solves", "[linear][condition]") {
  CountedSolver diagonal{VectorX::LinSpaced(50, 1.0, 50.0).asDiagonal()};
  CHECK_THAT(detail::inverse_norm_estimate(diagonal), WithinRel(50.0, 1e-14));
  CHECK(diagonal.solves == 3);  // the signs do not change
  MatrixX bar(40, 40);          // compliance of a bar in tension, fixed at one end
  for (Index i = 0; i < 40; ++i)
    for (Index j = 0; j < 40; ++j) bar(i, j) = static_cast<double>(std::min(i, j) + 1);
  CountedSolver solver{bar};
  CHECK_THAT(detail::inverse_norm_estimate(solver), WithinRel(largest_column_sum(bar), 1e-14));
  CHECK(solver.solves == 3);
  testing::Random random(7);
  int most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    MatrixX factor(30, 30);
    for (Index i = 0; i < factor.size(); ++i) factor.data()[i] = random.uniform(-1.0, 1.0);
    CountedSolver spd{factor * factor.transpose()};
    const double exact = largest_column_sum(spd.inverse), estimate = detail::inverse_norm_estimate(spd);
    CHECK(estimate <= exact * (1.0 + 1e-12));
    CHECK(3.0 * estimate > exact);
    most = std::max(most, spd.solves);
  }
  CHECK(most <= 8);
}

TEST_CASE("the probe shows the full loss of a single motion, and its place", "[linear][condition]") {
  const SoftDiagonal op;
  SoftSolver wrong;
  CHECK(probe_error(op, wrong) < 0.02);  // the soft motion is a small part of a random solution
  const detail::SoftestMotion found = detail::probe_softest_motion(op, wrong);
  CHECK_THAT(found.error, WithinRel(2.0 / 3.0, 1e-6));
  CHECK(found.largest == soft);
  SoftSolver right{1.0};
  CHECK(detail::probe_softest_motion(op, right).error <= 1e-12);
  SoftSolver infinite{0.0};
  CHECK(detail::probe_softest_motion(op, infinite).error == infinity);
}
