// Static equilibrium at large deformation, by Newton's method along a path of loads.
#pragma once

#include <palpate/assembly/free_values.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/integrator/newton.hpp>
#include <palpate/linear/repeated_cholesky.hpp>
#include <palpate/mesh/rigid_modes.hpp>

#include <memory>

namespace palpate::inline PALPATE_ABI {

struct EquilibriumParameters {
  NewtonParameters newton{};
  int load_steps = 1;           ///< to start with; a step that fails is halved, one that is easy doubled
  double smallest_step = 1e-4;  ///< of the loads; a smaller one gives up
};

struct EquilibriumReport {
  bool converged = false;
  int load_steps = 0, iterations = 0, refused_steps = 0;
  double fraction = 0.0;           ///< of the loads that are in equilibrium
  double relative_residual = 0.0;  ///< of the last step
  bool stable = true;              ///< the tangent stiffness is positive definite there
  DeformationReport deformation{};
};

/// What was reached, in a sentence.
inline std::string describe(const EquilibriumReport& r) {
  if (!r.converged)
    return "no equilibrium was found beyond " + number(100.0 * r.fraction) +
           " % of the loads; the most deformed element is " + std::to_string(r.deformation.worst_element) +
           " with a volume ratio of " + number(r.deformation.smallest_volume_ratio);
  std::string text = "equilibrium after " + std::to_string(r.load_steps) + " load steps and " +
                     std::to_string(r.iterations) + " iterations, residual " + number(r.relative_residual);
  if (!r.stable) text += ", not stable";
  if (r.deformation.inverted > 0)
    text += ", " + std::to_string(r.deformation.inverted) + " elements inside out, first of all " +
            std::to_string(r.deformation.worst_element);
  return text;
}

/// A body under dead loads and prescribed displacements. Neither copied nor moved.
class Equilibrium {
 public:
  /// Throws what assembly and conditions throw, unsupported for initial strains, unconstrained.
  template <Element E, HyperelasticMaterial M>
  Equilibrium(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {}) {
    auto elastic = std::make_unique<LargeStrain<E, M>>(std::move(body), limits);
    const Body<E>& rest = elastic->body().rest;
    if (!scene.initial_strains().empty())
      raise(SetupErrorKind::unsupported, "initial strains at large deformation", "Use a linear material");
    const auto boundary = extract_boundary<E>(rest.mesh);
    conditions_ = resolve_essential(rest.mesh, boundary, scene);
    require_constrained(rest.mesh, conditions_.constrained);
    load_ = applied_load(rest, boundary, scene);
    const VectorX mass = nodal_mass(rest);
    for (Index i = 0; i < mass.size(); ++i) load_.template segment<3>(3 * i) += mass[i] * scene.gravity();
    stiffness_ = make_stiffness(block_pattern(rest.mesh), limits);
    const std::vector<Vector3> positions = rest.mesh.positions;
    elastic_ = std::move(elastic);
    prepare_solver(positions, limits);
  }
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Raises the loads from none to all. What is reached at the end is in `displacement()`.
  EquilibriumReport solve(const EquilibriumParameters& parameters = {}) {
    EquilibriumReport report;
    Newton newton(conditions_.free_count(), parameters.newton);
    displacement_.setZero();
    fraction_ = 0.0;
    VectorX x = VectorX::Zero(conditions_.free_count()), start = x;
    double step = 1.0 / std::max(1, parameters.load_steps);
    while (fraction_ < 1.0) {
      const double from = fraction_, to = std::min(1.0, from + step);
      start = x;
      const NewtonReport found = advance(newton, to, x);
      report.iterations += found.iterations;
      if (found.converged) {
        ++report.load_steps;
        report.relative_residual = found.relative_residual;
        if (found.iterations <= 6) step *= 2.0;
        continue;
      }
      ++report.refused_steps;
      report.relative_residual = found.relative_residual;
      x = start;
      fraction_ = from;
      step *= 0.5;
      if (step < parameters.smallest_step) break;
    }
    report.fraction = fraction_;
    report.converged = fraction_ == 1.0;
    place(x);
    report.deformation = elastic_->internal_force(displacement_, force_);
    report.stable = prepare(x) && shift_ == 0.0;
    return report;
  }

  const ElasticForces& elastic() const noexcept { return *elastic_; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  const VectorX& displacement() const noexcept { return displacement_; }
  double energy() const noexcept { return elastic_->energy(displacement_); }
  VectorX internal_force() const {
    VectorX f(displacement_.size());
    elastic_->internal_force(displacement_, f);
    return f;
  }
  /// Forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const {
    VectorX r = internal_force() - fraction_ * load_;
    for (const Index dof : conditions_.free_dofs) r[dof] = 0.0;
    return r;
  }

  // NewtonProblem, at the present fraction of the loads
  Index size() const noexcept { return conditions_.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    place(x);
    const DeformationReport deformation = elastic_->internal_force(displacement_, force_);
    if (!deformation.admissible) return infinity;
    scale_ = std::max(force_.norm(), fraction_ * load_.norm());
    full_ = fraction_ * load_ - force_;
    conditions_.gather(full_, residual);
    return elastic_->energy(displacement_) - fraction_ * load_.dot(displacement_);
  }
  bool prepare(const VectorX& x) noexcept {
    place(x);
    elastic_->tangent(displacement_, stiffness_);
    values_.update(stiffness_, conditions_);
    shift_ = 0.0;
    if (factor_->factorise(values_.lower())) return true;
    // Past a limit point the tangent is not positive definite: a multiple of the unit matrix makes it so (Nocedal and
    // Wright, 3.4).
    for (double next = 1e-3 * largest_diagonal(); next <= 1e2 * largest_diagonal(); next *= 4.0) {
      values_.add_to_diagonal(next - shift_);
      shift_ = next;
      if (factor_->factorise(values_.lower())) return true;
    }
    return false;
  }
  void direction(const VectorX& residual, VectorX& d) noexcept {
    factor_->solve_into(residual, d);
    if (shift_ > 0.0 && residual.norm() <= 1e-3 * scale_) add_way_down(residual, d);
  }
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept { return rounding_; }

 private:
  void prepare_solver(const std::vector<Vector3>& positions, const SetupLimits& limits) {
    if (!load_.allFinite()) raise(SetupErrorKind::non_finite, "the loads are not finite");
    displacement_ = force_ = full_ = VectorX::Zero(elastic_->dof_count());
    elastic_->tangent(displacement_, stiffness_);
    values_ = FreeValues(stiffness_, conditions_);
    DofLayout layout{{}, positions, {}};
    for (const Index dof : conditions_.free_dofs) layout.node_of_dof.push_back(dof / 3);
    trial_.resize(size());
    buckling_ = VectorX::NullaryExpr(size(), [](Index i) { return std::sin(1.0 + static_cast<double>(i)); });
    Eigen::AlignedBox3d box;
    for (const Vector3& x : positions) box.extend(x);
    size_ = box.diagonal().norm();
    rounding_ =
        std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(size())) * largest_diagonal() * size_;
    factor_ = std::make_unique<RepeatedCholesky>(CholeskyAnalysis(values_.lower(), layout, limits), limits);
  }

  /// Full displacement from the free dofs, with prescribed ones at the present fraction.
  void place(const VectorX& x) noexcept {
    displacement_ = fraction_ * conditions_.prescribed;
    for (Index k = 0; k < conditions_.free_count(); ++k)
      displacement_[conditions_.free_dofs[static_cast<std::size_t>(k)]] = x[k];
  }

  /// From equilibrium at the present fraction to equilibrium at another: a step along the tangent, then Newton's
  /// method.
  NewtonReport advance(Newton& newton, double to, VectorX& x) noexcept {
    if (!prepare(x)) return {};
    elastic_->internal_force(displacement_, force_);
    stiffness_.apply((to - fraction_) * conditions_.prescribed, full_);
    full_ = to * load_ - force_ - full_;
    VectorX residual(size()), d(size());
    conditions_.gather(full_, residual);
    direction(residual, d);
    fraction_ = to;
    x += d;
    return newton.solve(*this, x);
  }

  /// Where the tangent is not positive definite the state may be an unstable equilibrium, which the residual alone does
  /// not leave (a column pressed straight): adds the direction of most negative curvature, by inverse iteration.
  void add_way_down(const VectorX& residual, VectorX& d) noexcept {
    double softest = infinity;
    for (int k = 0; k < 6; ++k) {
      buckling_.normalize();
      factor_->solve_into(buckling_, trial_);
      softest = 1.0 / buckling_.dot(trial_) - shift_;
      buckling_.swap(trial_);
    }
    if (!(softest < 0.0)) return;
    const double length = 0.02 * size_ / buckling_.cwiseAbs().maxCoeff();
    d += std::copysign(length, residual.dot(buckling_)) * buckling_;
  }

  double largest_diagonal() const noexcept {
    double largest = 0.0;
    for (const Matrix3& block : stiffness_.diagonal_blocks()) largest = std::max(largest, block.cwiseAbs().maxCoeff());
    return largest;
  }

  std::unique_ptr<ElasticForces> elastic_;
  EssentialConditions conditions_;
  BlockMatrix stiffness_;
  FreeValues values_;
  std::unique_ptr<RepeatedCholesky> factor_;
  VectorX load_, displacement_, force_, full_, buckling_, trial_;
  double fraction_ = 0.0, scale_ = 0.0, shift_ = 0.0, size_ = 0.0, rounding_ = 0.0;
};

}  // namespace palpate::inline PALPATE_ABI
