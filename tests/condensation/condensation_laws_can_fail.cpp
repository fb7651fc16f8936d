// One deliberate error for every check of the law suite of condensed systems.
#include <palpate/condensation/static_systems.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/testing/condensation_laws.hpp>

#include "linear/systems.hpp"

using namespace test;
using testing::violates;

namespace {

const MatrixX k = with_condition(20, 100.0);
const std::vector<Index> kept_dofs{1, 4, 5, 9};

/// A correct system with one error.
class Wrong {
 public:
  enum What {
    nothing,
    loses_condensed,
    offset,
    wrong_column,
    unsymmetric,
    negative,
    has_history,
    wrong_count,
    gives_up
  };
  explicit Wrong(What what) : what_(what) {}

  Index size() const { return right_.size(); }
  Index kept() const { return what_ == wrong_count ? 3 : right_.kept(); }
  std::size_t bytes() const { return 1; }

  /// The thesis drops P_f f_a: loads on condensed dofs are lost.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    VectorX load = b;
    if (what_ == loses_condensed) {
      load.setZero();
      for (Index i : kept_dofs) load[i] = b[i];
    }
    SolveReport report = right_.solve_into(load, x);
    if (what_ == offset) x[0] += 1e-30;
    if (what_ == gives_up) report.converged = false;
    return report;
  }
  SolveReport compliance_column(Index j, VectorX& column) noexcept {
    const SolveReport report = right_.compliance_column(what_ == wrong_column ? (j + 1) % 4 : j, column);
    if (what_ == unsymmetric && j == 0) column[2] += 1e-6 * column.norm();
    if (what_ == negative) column *= -1.0;
    if (what_ == has_history) column[0] += 1e-15 * ++calls_ * column.norm();
    return report;
  }

 private:
  What what_;
  Uncondensed right_{DenseCholesky(k, {}), kept_dofs};
  int calls_ = 0;
};

testing::Violations laws(Wrong::What what) {
  Wrong system(what);
  return testing::condensation_laws(op_of(k), system, kept_dofs);
}

}  // namespace

TEST_CASE("the law suite accepts a correct condensed system", "[testing][condensation]") {
  CHECK(testing::describe(laws(Wrong::nothing)) == "");
}

TEST_CASE("every check of the condensation law suite can fail", "[testing][condensation]") {
  CHECK(violates(laws(Wrong::loses_condensed), "displacement equals the full solve"));
  CHECK(violates(laws(Wrong::offset), "zero load gives zero"));
  CHECK(violates(laws(Wrong::wrong_column), "compliance equals the full solve"));
  CHECK(violates(laws(Wrong::unsymmetric), "compliance is symmetric"));
  CHECK(violates(laws(Wrong::negative), "compliance is positive definite"));
  CHECK(violates(laws(Wrong::has_history), "same column twice"));
  CHECK(violates(laws(Wrong::wrong_count), "number of kept dofs"));
  CHECK(violates(laws(Wrong::gives_up), "converges"));
}
