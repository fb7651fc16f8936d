// The exact contact solver compared with the enumeration of all active sets, and by its own optimality conditions.
#include <palpate/contact/detail/complementarity.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Dense>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

using namespace palpate;

namespace {

constexpr double relaxation = 1e-6;  // relative increase of the diagonal in solve()
struct Problem : detail::ComplementarityProblem {
  Problem() : detail::ComplementarityProblem(48) {}
  VectorX forces() const { return Eigen::Map<const VectorX>(lambda.data(), rows()); }
};

struct Case {
  MatrixX w;
  VectorX b;
};

MatrixX random_matrix(testing::Random& random, int rows, int columns) {
  MatrixX m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) m(i, j) = random.uniform(-1.0, 1.0);
  return m;
}

/// Positive definite with a condition of up to 10^decades.
Case random_case(testing::Random& random, int n, double decades) {
  const Eigen::HouseholderQR<MatrixX> qr(random_matrix(random, n, n));
  const MatrixX q = qr.householderQ();
  VectorX scale(n);
  for (int i = 0; i < n; ++i) scale[i] = std::pow(10.0, -random.uniform(0.0, decades));
  Case c;
  c.w = q * scale.asDiagonal() * q.transpose();
  c.w = 0.5 * (c.w + c.w.transpose()).eval();
  c.b.resize(n);
  for (int i = 0; i < n; ++i) c.b[i] = random.uniform(-1.0, 0.7);
  return c;
}

/// Contacts of a sphere with a half space of compliance `own` per point: normals within 60 degrees, coupled by the
/// compliance of the sphere's own motion.
Case sphere_case(testing::Random& random, int n, double own) {
  MatrixX normals(n, 3);
  Case c;
  c.b.resize(n);
  for (int i = 0; i < n; ++i) {
    normals.row(i) = Vector3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 1.2).normalized().transpose();
    c.b[i] = random.uniform(-1e-3, 5e-4);
  }
  for (int i = 1; i < n; i += 3) {  // exact copies
    normals.row(i) = normals.row(i - 1);
    c.b[i] = c.b[i - 1];
  }
  c.w = 2e-3 * normals * normals.transpose();
  c.w.diagonal().array() += own;
  return c;
}

void start_from(Problem& problem, const VectorX& lambda) {
  std::copy(lambda.begin(), lambda.end(), problem.lambda.begin());
}

void load(Problem& problem, const Case& c) {
  const int n = static_cast<int>(c.b.size());
  problem.resize(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) problem.w(i, j) = c.w(i, j);
    problem.b[static_cast<std::size_t>(i)] = c.b[i];
  }
  start_from(problem, VectorX::Zero(n));
}

/// The solution that satisfies all conditions, found by trying all 2^n active sets.
VectorX enumerate(const Case& c) {
  const int n = static_cast<int>(c.b.size());
  VectorX best = VectorX::Zero(n);
  double least = infinity;
  for (unsigned set = 0; set < 1u << n; ++set) {
    std::vector<int> active;
    for (int i = 0; i < n; ++i)
      if ((set >> i & 1u) != 0) active.push_back(i);
    const auto m = static_cast<Index>(active.size());
    VectorX lambda = VectorX::Zero(n);
    if (m > 0) {
      const MatrixX part = c.w(active, active);
      const VectorX load = -c.b(active);
      lambda(active) = VectorX(part.ldlt().solve(load));
    }
    const VectorX gap = c.b + c.w * lambda;
    const double violation = std::max(-lambda.minCoeff(), -gap.minCoeff());
    if (violation < least) {
      least = violation;
      best = lambda;
    }
  }
  return best;
}

/// Largest violation of lambda >= 0, gap >= 0, lambda * gap = 0, all as gaps relative to max |b|, with the relaxed
/// diagonal.
double violation(const Case& c, const Problem& problem) {
  const VectorX lambda = problem.forces();
  MatrixX w = c.w;
  w.diagonal() *= 1.0 + relaxation;
  const VectorX gap = c.b + w * lambda;
  const double scale = c.b.cwiseAbs().maxCoeff();
  double worst = 0.0;
  for (Index i = 0; i < gap.size(); ++i) {
    worst = std::max(worst, -lambda[i] * w(i, i) / scale);
    worst = std::max(worst, -gap[i] / scale);
    if (lambda[i] > 0.0) worst = std::max(worst, std::abs(gap[i]) / scale);
  }
  return worst;
}

}  // namespace

TEST_CASE("up to 8 contacts: the solution equals that of the enumeration of active sets",
          "[contact][complementarity]") {
  testing::Random random(51);
  double worst = 0.0;
  int unsolved = 0;
  for (int round = 0; round < 60; ++round)
    for (int n = 1; n <= 8; ++n) {
      const Case c = random_case(random, n, round % 3);
      Problem problem;
      load(problem, c);
      if (!problem.solve()) ++unsolved;
      const VectorX expected = enumerate(c);
      const double softest = Eigen::SelfAdjointEigenSolver<MatrixX>(c.w).eigenvalues()[0];
      const double allowed = 2.0 * relaxation * c.w.diagonal().maxCoeff() * expected.norm() / softest + 1e-12;
      worst = std::max(worst, (problem.forces() - expected).norm() / allowed);
    }
  CHECK(unsolved == 0);
  CHECK(worst <= 1.0);
}

TEST_CASE("up to 48 contacts: complementarity holds", "[contact][complementarity]") {
  testing::Random random(52);
  double worst = 0.0;
  int unsolved = 0, most = 0;
  for (int round = 0; round < 150; ++round)
    for (int n : {1, 3, 9, 17, 33, 48}) {
      const Case c = random_case(random, n, round % 5);
      Problem problem;
      load(problem, c);
      if (!problem.solve()) ++unsolved;
      worst = std::max(worst, violation(c, problem));
      most = std::max(most, problem.pivots);
    }
  INFO("most pivots of 900 random problems: " << most << ", worst violation " << worst);
  CHECK(unsolved == 0);
  CHECK(worst <= 1e-9);
}

TEST_CASE("more contacts than degrees of freedom, including duplicates", "[contact][complementarity][extreme]") {
  testing::Random random(53);
  double worst = 0.0, worst_sum = 0.0;
  int unsolved = 0, most = 0;
  for (int round = 0; round < 300; ++round)
    for (double own : {0.0, 1e-9, 1e-4}) {
      const Case c = sphere_case(random, 48, own);
      Problem problem;
      load(problem, c);
      if (!problem.solve()) ++unsolved;
      worst = std::max(worst, violation(c, problem));
      most = std::max(most, problem.pivots);
      // The tool's displacement is unique even where the forces are not: the gaps of the unrelaxed problem hold.
      const VectorX gap = c.b + c.w * problem.forces();
      worst_sum = std::max(worst_sum, -gap.minCoeff() / c.b.cwiseAbs().maxCoeff());
    }
  INFO("most pivots of 900 redundant problems: " << most << ", worst violation " << worst << ", deepest gap "
                                                 << worst_sum);
  CHECK(unsolved == 0);
  CHECK(worst <= 1e-6);
  CHECK(worst_sum <= 1e-4);
}

TEST_CASE("any initial value gives the same solution", "[contact][complementarity]") {
  testing::Random random(54);
  int different = 0, unsolved = 0, warm = 0, cold = 0;
  for (int round = 0; round < 200; ++round) {
    const Case c = random_case(random, 24, 2.0);
    Problem problem;
    load(problem, c);
    if (!problem.solve()) ++unsolved;
    const VectorX answer = problem.forces();
    cold += problem.pivots;
    load(problem, c);
    start_from(problem, answer);
    if (!problem.solve()) ++unsolved;
    warm += problem.pivots;
    if (!(problem.forces() - answer).isZero(1e-12 * answer.norm())) ++different;
    load(problem, c);
    for (std::size_t i = 0; i < 24; ++i) problem.lambda[i] = random.uniform(-1.0, 1.0) * 1e3;
    if (!problem.solve()) ++unsolved;
    if (!(problem.forces() - answer).isZero(1e-9 * answer.norm())) ++different;
  }
  CHECK(unsolved == 0);
  CHECK(different == 0);
  CHECK(warm < cold / 4);
}

TEST_CASE("rows that are added to a solution give the solution of all rows, and gaps are those of the forces",
          "[contact][complementarity]") {
  testing::Random random(57);
  int unsolved = 0, different = 0, wrong_gaps = 0;
  for (int round = 0; round < 200; ++round) {
    const Case c = random_case(random, 24, 2.0);
    Problem whole, grown;
    load(whole, c);
    unsolved += !whole.solve();
    load(grown, c);
    int first = 4 + round % 17;
    grown.resize(first);
    unsolved += !grown.solve();
    for (const int rows : {first + 3, 24}) {
      grown.resize(rows);
      for (int i = first; i < rows; ++i) grown.lambda[static_cast<std::size_t>(i)] = 1.0;
      unsolved += !grown.solve_added(first);
      first = rows;
    }
    different += !((grown.forces() - whole.forces()).norm() < 1e-9 * whole.forces().norm());
    const VectorX gap = c.b + c.w * grown.forces();
    for (int i = 0; i < 24; ++i) wrong_gaps += !(std::abs(grown.gap(i) - gap[i]) < 1e-12);
  }
  CHECK(unsolved == 0);
  CHECK(different == 0);
  CHECK(wrong_gaps == 0);
}

TEST_CASE("without penetration there is no force", "[contact][complementarity]") {
  testing::Random random(55);
  for (int n : {1, 7, 48}) {
    Case c = random_case(random, n, 2.0);
    c.b = c.b.cwiseAbs().array() + 1e-6;
    Problem problem;
    load(problem, c);
    start_from(problem, VectorX::Constant(n, 1.0));
    CHECK(problem.solve());
    CHECK(problem.forces().isZero(0.0));
    c.b.setZero();
    load(problem, c);
    CHECK(problem.solve());
    CHECK(problem.forces().isZero(1e-12));
  }
  Problem nothing;
  nothing.resize(0);
  CHECK(nothing.solve());
}

TEST_CASE("one contact: the force is minus gap over compliance", "[contact][complementarity]") {
  Problem problem;
  for (double compliance : {1e-9, 1e-3, 1e3})
    for (double gap : {-1e-9, -1e-3, -1.0}) {
      problem.resize(1);
      problem.w(0, 0) = compliance;
      problem.b[0] = gap;
      problem.lambda[0] = 0.0;
      CHECK(problem.solve());
      CHECK_THAT(problem.lambda[0] * compliance / -gap, Catch::Matchers::WithinAbs(1.0, 2.0 * relaxation));
    }
}

TEST_CASE("pivots are bounded and the result is finite for any magnitudes", "[contact][complementarity][extreme]") {
  testing::Random random(56);
  int not_finite = 0, negative = 0, too_many = 0;
  for (int round = 0; round < 400; ++round) {
    Case c = round % 2 == 0 ? random_case(random, 48, 16.0) : sphere_case(random, 48, 0.0);
    for (Index i = 0; i < 48; ++i) c.b[i] *= std::pow(10.0, random.uniform(-12.0, 6.0));
    Problem problem;
    load(problem, c);
    problem.solve();
    if (!problem.forces().allFinite()) ++not_finite;
    if (problem.forces().minCoeff() < 0.0) ++negative;
    if (problem.pivots > problem.maximum_pivots()) ++too_many;
  }
  CHECK(not_finite == 0);
  CHECK(negative == 0);
  CHECK(too_many == 0);
}

TEST_CASE("rows without compliance get no force and do not affect others", "[contact][complementarity][extreme]") {
  Problem problem;
  problem.resize(3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) problem.w(i, j) = i == 0 && j == 0 ? 2.0 : 0.0;
  problem.b[0] = problem.b[1] = -1.0;
  problem.b[2] = 1.0;
  start_from(problem, VectorX::Zero(3));
  problem.solve();
  CHECK(problem.forces().allFinite());
  CHECK_THAT(problem.lambda[0], Catch::Matchers::WithinAbs(0.5, 1e-6));
}

TEST_CASE("NaN and infinity end the solve and are not reported as solved", "[contact][complementarity][extreme][D1]") {
  testing::Random random(57);
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {nan_value, infinity, -infinity})
    for (int where = 0; where < 3; ++where) {
      const Case c = random_case(random, 12, 1.0);
      Problem problem;
      load(problem, c);
      if (where == 0) problem.b[3] = bad;
      if (where == 1) problem.w(5, 5) = bad;
      if (where == 2) problem.w(2, 7) = problem.w(7, 2) = bad;
      const bool solved = problem.solve();
      CHECK(problem.pivots <= problem.maximum_pivots());
      const bool no_lie = !solved || problem.forces().allFinite();
      INFO("value " << bad << " at place " << where);
      CHECK(no_lie);
    }
}

TEST_CASE("a row that a matrix without positive definiteness cannot close is reported",
          "[contact][complementarity][extreme]") {
  Problem p;
  p.resize(2);
  p.w(0, 0) = -1.0, p.w(1, 1) = 2.0, p.w(0, 1) = p.w(1, 0) = 0.0;
  p.b[0] = -1.0, p.b[1] = -1.0;
  p.lambda[0] = p.lambda[1] = 1.0;
  CHECK(!p.solve());
  CHECK((std::isfinite(p.lambda[0]) && p.lambda[0] >= 0.0));
  // Two rows of one point: one has the force, the other is closed by it.
  p.w(0, 0) = p.w(1, 1) = p.w(0, 1) = p.w(1, 0) = 1.0;
  p.lambda[0] = p.lambda[1] = 1.0;
  CHECK(p.solve());
  CHECK_THAT(p.lambda[0] + p.lambda[1], Catch::Matchers::WithinRel(1.0, 1e-5));
}
