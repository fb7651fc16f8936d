// Natural frequencies and mode shapes of a body.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/linear/detail/block_lanczos.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The lowest elastic modes of a body in ascending order, and its remaining rigid motions.
struct NaturalFrequencies {
  VectorX frequencies;    ///< [Hz]
  MatrixX shapes;         ///< one per column, 3 per node, shape^T M shape = 1 kg m^2; its largest component is positive
  VectorX residuals;      ///< |K x - omega^2 M x| / |K x| [-]; meaningless at zero frequency (a mechanism)
  MatrixX rigid_shapes;   ///< motions without strain, at zero frequency, also M-orthonormal; six for a free body
  double rounding = 0.0;  ///< largest relative difference of omega^2 (beyond the shift) computed from the factor and
                          ///< from the matrices: digits lost by contrast and slenderness; above 1e-3 an error is thrown

  int rigid_modes() const noexcept { return static_cast<int>(rigid_shapes.cols()); }
};

namespace detail {

/// K and M of the free dofs, and the rigid motions of these dofs.
struct ModalProblem {
  SparseMatrix stiffness, mass;  // lower halves
  MatrixX rigid;

  static MatrixX times(const SparseMatrix& lower, const MatrixX& x) {
    return lower.selfadjointView<Eigen::Lower>() * x;
  }

  /// x^T K x / x^T M x of every column [1/s^2].
  VectorX rayleigh(const MatrixX& x) const {
    const VectorX energy = x.cwiseProduct(times(stiffness, x)).colwise().sum().transpose();
    return energy.cwiseQuotient(x.cwiseProduct(times(mass, x)).colwise().sum().transpose());
  }
};

/// Refuses a region without mass: its inertia would be missing from the matrix.
template <Element E>
void require_density(const Body<E>& body) {
  for (std::size_t r = 0; r < body.density.size(); ++r) {
    if (body.density[r] > 0.0 && std::isfinite(body.density[r])) continue;
    SetupProblem p;
    p.kind = SetupErrorKind::bad_density;
    p.what = "region '" + body.mesh.region_names[r] + "' has a density of " + number(body.density[r]);
    p.hint = "Natural frequencies need the density of every region, in kg/m^3";
    p.ids = {static_cast<std::int64_t>(r)};
    p.count = 1;
    p.value = body.density[r];
    raise(std::move(p));
  }
}

inline void require_count(Index wanted, Index available) {
  if (wanted >= 1 && wanted <= available) return;
  SetupProblem p;
  p.kind = wanted < 1 ? SetupErrorKind::bad_argument : SetupErrorKind::count_too_large;
  p.what = std::to_string(wanted) + " natural frequencies are requested, the body has " + std::to_string(available);
  p.hint = "Request at least one, and at most as many as free dofs minus rigid motions";
  p.value = static_cast<double>(wanted);
  p.threshold = static_cast<double>(available);
  raise(std::move(p));
}

/// The frequency scale of a body that can move rigidly [1/s^2]: the lowest Rayleigh quotient of the six uniform strains
/// after their rigid part is removed.
template <Element E>
double uniform_strain_quotient(const Body<E>& body, const EssentialConditions& conditions,
                               const ModalProblem& problem) {
  const Vector3 origin = body.mesh.position(0);
  MatrixX fields(conditions.free_count(), 6);
  VectorX full(conditions.dof_count()), part(conditions.free_count());
  for (int k = 0; k < 6; ++k) {
    const Matrix3 strain = voigt::stress_tensor(Vector6::Unit(k));
    for (Index i = 0; i < body.mesh.node_count(); ++i)
      full.segment<3>(3 * i) = strain * (body.mesh.position(i) - origin);
    conditions.gather(full, part);
    fields.col(k) = part;
  }
  const MatrixX& z = problem.rigid;
  const MatrixX gram = z.transpose() * ModalProblem::times(problem.mass, z);
  fields -= z * gram.ldlt().solve(z.transpose() * ModalProblem::times(problem.mass, fields));
  return problem.rayleigh(fields).minCoeff();
}

/// Modes of the free dofs as shapes of all nodes, each with its largest component positive.
inline MatrixX full_shapes(const MatrixX& free, const EssentialConditions& conditions) {
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

/// Builds the result from the modes of the free dofs: sorted, on all nodes, with their residuals. A template so that it
/// is compiled only where it is used.
template <class Problem>
NaturalFrequencies natural_frequencies_of(const Problem& problem, const MatrixX& modes,
                                          const EssentialConditions& conditions) {
  const VectorX lambda = problem.rayleigh(modes);
  std::vector<Index> order(static_cast<std::size_t>(lambda.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, {}, [&](Index k) { return lambda[k]; });
  const MatrixX sorted = modes(Eigen::all, order);
  const VectorX squares = lambda(order);
  const MatrixX forces = Problem::times(problem.stiffness, sorted);
  const MatrixX inertia = Problem::times(problem.mass, sorted) * squares.asDiagonal();

  NaturalFrequencies result;
  result.frequencies = squares.cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
  result.residuals = (forces - inertia).colwise().norm().cwiseQuotient(forces.colwise().norm()).transpose();
  result.shapes = full_shapes(sorted, conditions);
  const MatrixX gram = problem.rigid.transpose() * Problem::times(problem.mass, problem.rigid);
  const MatrixX orthonormal = gram.llt().matrixL().solve(problem.rigid.transpose()).transpose();
  result.rigid_shapes = full_shapes(orthonormal, conditions);
  return result;
}

/// Largest relative difference between theta, computed from the factor only, and the Rayleigh quotients of K and M.
/// Refuses pairs that did not converge or differ by more than 1e-3.
inline double require_pairs(const LanczosPairs& pairs, const VectorX& lambda, double shift, double tolerance) {
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

}  // namespace detail

/// The `count` lowest natural frequencies of a body constrained as in `scene` (prescribed components stay at rest for
/// any prescribed value; loads are ignored), or of a free body. The remaining rigid motions are found from the
/// geometry, returned separately and not counted. An eigenvalue of multiplicity m is returned m times; its shapes are
/// an arbitrary basis. Consistent mass, stiffness with the quadrature of the element: frequencies converge from above
/// when both are exact.
///
///   auto modes = natural_frequencies(model.body(), scene, 6);                                // of a model
///   auto modes = natural_frequencies(make_body(admit<Tet10>(mesh).mesh, material), {}, 6);   // of a free body
///
/// Node ids and positions in `scene` refer to the mesh of the body; for the body of a model use
/// `scene.mapped(model.node_map(), model.origin())`, unless the scene selects by names only.
///
/// Throws bad_density for a region without mass, bad_argument or count_too_large for the count, not_positive_definite
/// for a constrained body that is a mechanism, not_converged, ill_conditioned, too_large, cancelled, and the errors of
/// assembly and conditions. Cost: a sparse factorisation of K - sigma M (sigma = 0 for a constrained body) and some 10
/// solves with count + 4 right-hand sides; a body with much softer parts may take up to four factorisations.
template <Element E>
NaturalFrequencies natural_frequencies(const Body<E>& body, const Scene& scene, int count,
                                       const SetupLimits& limits = {}) {
  constexpr double tolerance = 1e-9;  // of theta; the error of a frequency is of the order of its square
  detail::require_density(body);
  const EssentialConditions conditions = resolve_essential(body.mesh, extract_boundary<E>(body.mesh), scene);
  const MatrixX rigid_motions = detail::rigid_displacements(body.mesh, conditions.constrained);
  detail::require_count(count, conditions.free_count() - rigid_motions.cols());
  limits.require_memory(detail::BlockLanczos::bytes(conditions.free_count(), rigid_motions.cols(), count), "the modes");

  detail::ModalProblem problem{free_matrix(assemble_stiffness<E>(body, limits), conditions),
                               free_matrix(assemble_mass<E>(body, limits), conditions),
                               rigid_motions(conditions.free_dofs, Eigen::all)};
  const bool constrained = problem.rigid.cols() == 0;
  double shift = constrained ? 0.0 : -1e-2 * detail::uniform_strain_quotient(body, conditions, problem);
  detail::LanczosPairs pairs;
  VectorX lambda;
  for (int attempt = 0; attempt < (constrained ? 1 : 4) && !pairs.converged; ++attempt) {
    if (attempt > 0)
      shift = -1e-2 * lambda.cwiseAbs().minCoeff();  // far below the uniform strains: restart with this shift
    const SparseCholesky factor(
        constrained ? problem.stiffness : SparseMatrix(problem.stiffness - shift * problem.mass), limits);
    detail::BlockLanczos lanczos(factor, problem.mass, problem.rigid, count);
    pairs = lanczos.run(tolerance, constrained ? 200 : 40, limits);
    lambda = problem.rayleigh(pairs.vectors);
  }
  const double rounding = detail::require_pairs(pairs, lambda, shift, tolerance);
  NaturalFrequencies result = detail::natural_frequencies_of(problem, pairs.vectors, conditions);
  result.rounding = rounding;
  return result;
}

}}  // namespace palpate
