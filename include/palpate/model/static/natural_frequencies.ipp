// Definitions of natural_frequencies.hpp.
#pragma once

#include <palpate/model/static/natural_frequencies.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE MatrixX ModalProblem::times(const SparseMatrix& lower, const MatrixX& x) {
  return lower.selfadjointView<Eigen::Lower>() * x;
}

PALPATE_INLINE VectorX ModalProblem::rayleigh(const MatrixX& x) const {
  const VectorX energy = x.cwiseProduct(times(stiffness, x)).colwise().sum().transpose();
  return energy.cwiseQuotient(x.cwiseProduct(times(mass, x)).colwise().sum().transpose());
}

PALPATE_INLINE void require_count(Index wanted, Index available) {
  if (wanted >= 1 && wanted <= available) return;
  SetupProblem p;
  p.kind = wanted < 1 ? SetupErrorKind::bad_argument : SetupErrorKind::count_too_large;
  p.what = std::to_string(wanted) + " natural frequencies are requested, the body has " + std::to_string(available);
  p.hint = "Request at least one, and at most as many as free dofs minus rigid motions";
  p.value = static_cast<double>(wanted);
  p.threshold = static_cast<double>(available);
  raise(std::move(p));
}

PALPATE_INLINE MatrixX full_shapes(const MatrixX& free, const EssentialConditions& conditions) {
  MatrixX shapes(conditions.dof_count(), free.cols());
  VectorX full(conditions.dof_count());
  for (Index k = 0; k < free.cols(); ++k) {
    conditions.scatter(free.col(k), full);
    Index largest = 0;
    full.cwiseAbs().maxCoeff(&largest);
    shapes.col(k) = full[largest] < 0.0 ? VectorX(-full) : full;
  }
  return shapes;
}

PALPATE_INLINE double require_pairs(const LanczosPairs& pairs, const VectorX& lambda, double shift, double tolerance) {
  SetupProblem p;
  p.kind = SetupErrorKind::not_converged;
  p.hint = "Look for parts that are far softer or far lighter than others";
  p.value = pairs.residual;
  p.threshold = tolerance;
  p.what =
      "the natural frequencies did not converge: residual " + number(pairs.residual) + ", bound " + number(tolerance);
  if (!pairs.converged || !all_finite(lambda)) raise(std::move(p));
  const double rounding = ((lambda.array() - shift) * pairs.theta.array() - 1.0).abs().maxCoeff();
  if (rounding <= 1e-3) return rounding;
  p.kind = SetupErrorKind::ill_conditioned;
  p.what = "rounding changes the square of a natural frequency by a factor of 1 +- " + number(rounding);
  p.hint = "Parts are too different in stiffness, or the body is too slender";
  p.value = rounding;
  p.threshold = 1e-3;
  raise(std::move(p));
}

}}}  // namespace palpate::detail
