// Map of statics: which answers hold, over Poisson's ratio, contrast, element quality and solver.
#pragma once

#include "grid.hpp"

#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>

#include <limits>
#include <optional>

namespace maps {

using namespace palpate;

/// A block that is held at one end and pulled at the other, in two materials. Whoever solves it gets this and no more.
struct StaticProblem {
  Mesh<Tet4> mesh;
  std::vector<LinearElastic> materials;  ///< by region
  std::vector<NodeId> constrained, pulled, touched;
  Vector3 force = Vector3(1.0, 0.5, -2.0);  ///< [N] in all, shared equally by `pulled`
};

/// What a solver says.
struct Answer {
  bool refused = false, flagged = false;
  double estimate = 0.0;  ///< of its own error, where it flags
  double quality = 1.0;   ///< of the worst element
  std::string why;
  VectorX displacement;  ///< 3 per node [m]
  MatrixX compliance;    ///< of the touched nodes, 3 per node [m/N]; empty where it has none
};

struct StaticSolver {
  std::string name;
  bool ours = true;
  double bound = 1e-5;  ///< relative error that a silent answer may have
  Answer (*solve)(const StaticProblem&) = nullptr;
};
/// Five policies of HapticFEModel, with admission, checks and report.
std::vector<StaticSolver> our_solvers();
/// Eigen's solvers on the same equations, asked for info() and nothing else.
std::vector<StaticSolver> plain_solvers();

/// Error of an answer against long double: the larger one of displacement (2-norm) and compliance (largest entry).
class Truth {
 public:
  explicit Truth(const StaticProblem& problem);
  /// False where even the matrix of the reference is not positive definite: there is no right answer.
  bool exists() const noexcept { return exists_; }
  /// Relative error that the reference itself may have: ten times that of a solve with a known answer.
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
/// `cells` per edge of the block. Writes statics.csv and prints what is wrong.
StaticMap measure_statics(int cells, const std::string& folder);

}  // namespace maps
