// Map of statics: verdict of a solution, over Poisson's ratio, contrast, element quality and solver.
#pragma once

#include "grid.hpp"

#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>

#include <limits>
#include <optional>

namespace maps {

using namespace palpate;

/// A block of two materials, fixed at one end and loaded at the other. The only input of a solver.
struct StaticProblem {
  Mesh<Tet4> mesh;
  std::vector<LinearElastic> materials;  ///< by region
  std::vector<NodeId> constrained, pulled, touched;
  Vector3 force = Vector3(1.0, 0.5, -2.0);  ///< [N] total, distributed equally over `pulled`
};

/// Result of a solver.
struct Answer {
  bool refused = false, flagged = false;
  double estimate = 0.0;  ///< its error estimate, when it flags the result
  double quality = 1.0;   ///< quality of the worst element
  std::string why;
  VectorX displacement;  ///< 3 per node [m]
  MatrixX compliance;    ///< of the touched nodes, 3 per node [m/N]; empty when not computed
};

struct StaticSolver {
  std::string name;
  bool ours = true;
  double bound = 1e-5;  ///< largest allowed relative error of a result without a flag
  Answer (*solve)(const StaticProblem&) = nullptr;
};
/// Five policies of HapticFEModel, with admission, checks and report.
std::vector<StaticSolver> our_solvers();
/// Eigen's solvers on the same equations; only info() is checked.
std::vector<StaticSolver> plain_solvers();

/// Error of a result relative to a long double solution: the larger of displacement (2-norm) and compliance (largest
/// entry).
class Truth {
 public:
  explicit Truth(const StaticProblem& problem);
  /// False when the matrix of the reference is not positive definite: there is no solution.
  bool exists() const noexcept { return exists_; }
  /// Relative error of the reference: ten times that of a solve with a known solution.
  double uncertainty() const noexcept { return 10.0 * probe_; }
  double error(const Answer& answer) const;

 private:
  VectorX displacement_;
  MatrixX compliance_;
  double probe_ = infinity;
  bool exists_ = false;
};

struct StaticCell {
  const StaticSolver* solver = nullptr;
  std::string quality, nu, contrast;
  Answer answer;
  double error = std::numeric_limits<double>::quiet_NaN();
  Verdict verdict = Verdict::refused;
};
Verdict judge(const StaticSolver& solver, const Answer& answer, const Truth& truth, double& error);

struct StaticMap {
  std::vector<Grid> ours, others, defects;
  Score score;
};
/// `cells` per edge of the block. Writes statics.csv and prints every cell that is WRONG.
StaticMap measure_statics(int cells, const std::string& folder);

}  // namespace maps
