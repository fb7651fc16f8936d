// Accuracy of a solver for the softest motion.
#include <palpate/linear/condition.hpp>

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

}  // namespace

TEST_CASE("the probe shows the full loss of a single motion, and its place", "[linear][condition]") {
  const SoftDiagonal op;
  SoftSolver wrong;
  CHECK(probe_error(op, wrong) < 0.02);  // the soft motion is a small part of a random solution
  const SoftestMotion found = probe_softest_motion(op, wrong);
  CHECK_THAT(found.error, WithinRel(2.0 / 3.0, 1e-6));
  CHECK(found.largest == soft);
  SoftSolver right{1.0};
  CHECK(probe_softest_motion(op, right).error <= 1e-12);
  SoftSolver infinite{0.0};
  CHECK(probe_softest_motion(op, infinite).error == infinity);
}
