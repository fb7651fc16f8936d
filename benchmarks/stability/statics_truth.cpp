// Reference solution: dense Cholesky in long double of a stiffness computed in long double.
#include "closed_form.hpp"

#include <Eigen/Cholesky>

namespace maps {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Relative error of a solve with a known solution.
double probe(const Matrix& k, const Eigen::LLT<Matrix>& factor) {
  Vector known(k.rows());
  for (Index i = 0; i < known.size(); ++i) known[i] = std::sin(Real(1) + Real(7) * static_cast<Real>(i));
  const Vector found = factor.solve(k * known);
  return static_cast<double>((found - known).norm() / known.norm());
}

}  // namespace

Truth::Truth(const StaticProblem& problem) {
  const auto [index, count] = free_dofs(problem);
  Matrix k = Matrix::Zero(count, count);
  add_stiffness<Real>(problem, index, [&k](Index i, Index j, Real value) { k(i, j) += value; });
  if (!k.allFinite()) return;
  const Eigen::LLT<Matrix> factor(k);
  exists_ = factor.info() == Eigen::Success;
  if (!exists_) return;
  probe_ = probe(k, factor);
  const Vector load = load_of(problem, index, count).cast<Real>();
  displacement_ = spread(factor.solve(load).cast<double>(), index);

  const Index touched = 3 * static_cast<Index>(problem.touched.size());
  Matrix unit = Matrix::Zero(count, touched);
  const auto dof = [&, &free = index](Index t) {
    return free[static_cast<std::size_t>(3 * problem.touched[static_cast<std::size_t>(t / 3)] + t % 3)];
  };
  for (Index t = 0; t < touched; ++t)
    if (dof(t) >= 0) unit(dof(t), t) = 1;
  const Matrix columns = factor.solve(unit);
  compliance_ = MatrixX::Zero(touched, touched);
  for (Index t = 0; t < touched; ++t)
    if (dof(t) >= 0) compliance_.row(t) = columns.row(dof(t)).cast<double>();
}

double Truth::error(const Answer& answer) const {
  const double worst = (answer.displacement - displacement_).norm() / displacement_.norm();
  if (answer.compliance.size() == 0) return std::isfinite(worst) ? worst : infinity;
  const double of_compliance =
      (answer.compliance - compliance_).cwiseAbs().maxCoeff() / compliance_.cwiseAbs().maxCoeff();
  return answer.compliance.allFinite() && std::isfinite(worst) ? std::max(worst, of_compliance) : infinity;
}

Verdict judge(const StaticSolver& solver, const Answer& answer, const Truth& truth, double& error) {
  if (answer.refused) return Verdict::refused;
  if (!truth.exists()) return Verdict::wrong;
  error = truth.error(answer);
  // The error of a flagged result must not exceed 100 times its estimate.
  const double allowed = answer.flagged ? std::max(solver.bound, 100.0 * answer.estimate) : solver.bound;
  if (std::abs(error - allowed) <= truth.uncertainty()) return Verdict::unjudged;
  if (!(error <= allowed)) return Verdict::wrong;
  return answer.flagged ? Verdict::flagged : Verdict::ok;
}

}  // namespace maps
