// Stress relaxation by a Prony series.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/detail/material_range.hpp>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// One term of a Prony series: `share` of the stress relaxes with this time.
struct PronyTerm {
  double share = 0.0;            ///< g_i [-], relative to the stress right after a sudden strain
  double relaxation_time = 0.0;  ///< tau_i [s]
};

namespace detail {

/// (1 - exp(-x)) / x, the mean of exp(-t) over 0 ... x.
inline double mean_decay(double x) noexcept {
  return x > 0.0 ? -std::expm1(-x) / x : 1.0;
}

}  // namespace detail

/// The part of the stress that relaxes: all of it, or the deviatoric part. The whole stress is for small strain: where
/// a body is stretched to J > (lambda + 2 mu) / (lambda + mu) the stress S that relaxes has a negative shear stiffness,
/// and its history feeds any disturbance with energy (J = 1.10 at nu = 0.45, 1.02 at 0.49).
enum class Relaxation { whole_stress, deviatoric };

/// Viscoelastic history of an integration point: plain numbers, zero at rest. `Stress` is Vector6 at small strain and
/// Tensor3<double>, second Piola-Kirchhoff, at large strain.
template <class Stress, int Terms>
struct StressHistory {
  Stress elastic{};                    ///< of the base, at the end of the last step [Pa]
  std::array<Stress, Terms> fading{};  ///< h_i [Pa]
  StressHistory() noexcept {
    if constexpr (std::is_same_v<Stress, Vector6>) {
      elastic.setZero();
      for (Stress& h : fading) h.setZero();
    }
  }
};

namespace detail {

/// Coefficients of a series over a step dt: S = share S0' + sum (decay_i h_i - gain_i S0), h_i' = decay_i h_i + gain_i
/// (S0' - S0), where S0 is the stress of the base at the start and S0' at the end.
template <int Terms>
struct PronyStep {
  double share = 1.0;  ///< dS / dS0' [-]
  std::array<double, Terms> decay{}, gain{};
};

/// The stress of a material under a pure change of volume: U(J) = W(J^(1/3) I), for J > 0.
template <class Base>
class VolumeStress {
 public:
  VolumeStress(const Base& base, const Tensor3<double>& f) noexcept
      : base_(base), cofactor_(cofactor(f)), side_(std::cbrt(determinant(f, cofactor_))) {
    pressure_ = trace(base.stress(sphere())) / (3.0 * side_ * side_);
  }

  double energy() const noexcept { return base_.energy(sphere()); }
  /// dU/dF = U' cof F [Pa]
  Tensor3<double> stress() const noexcept { return pressure_ * cofactor_; }
  /// d2U/dF2
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    const auto unit = vector9(Tensor3<double>::identity());
    const double along =
        unit.dot(base_.tangent(sphere()) * unit) / (3.0 * side_ * side_);  // d(3 s^2 U')/ds and its share
    const double second = (along - 2.0 * pressure_ / side_) / (3.0 * side_ * side_);
    const auto column = vector9(cofactor_);
    Matrix9 t = pressure_ * cofactor_derivative(f);
    t += (second * column) * column.transpose();
    return t;
  }

 private:
  Tensor3<double> sphere() const noexcept { return Tensor3<double>::diagonal(side_, side_, side_); }

  const Base& base_;
  Tensor3<double> cofactor_;
  double side_, pressure_ = 0.0;
};

}  // namespace detail

/// The incremental potential of a Prony series over a step (Ortiz and Stainier 1999), after relaxation over the step:
///   W = share W0(F) + kept U(J) + driving : E,   E = (F^T F - I)/2,
/// where `driving` is the remaining second Piola-Kirchhoff stress of the history and U the part of W0 from a change of
/// volume. It exists for every base, so a viscoelastic step is minimised like an elastic one. Needs J > 0. Refers to
/// the base.
template <class Base>
struct ViscousStep {
  const Base& base;
  double share, kept;
  Tensor3<double> driving;

  double energy(const Tensor3<double>& f) const noexcept {
    const Tensor3<double> h = detail::from_rest(f);
    double w = share * base.energy(f) + contract(driving, h) + 0.5 * contract(h * driving, h);
    if (kept != 0.0) w += kept * detail::VolumeStress<Base>(base, f).energy();
    return w;
  }
  Tensor3<double> stress(const Tensor3<double>& f) const noexcept {
    Tensor3<double> p = share * base.stress(f) + f * driving;
    if (kept != 0.0) p = p + kept * detail::VolumeStress<Base>(base, f).stress();
    return p;
  }
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    Matrix9 t = share * base.tangent(f);
    detail::add_right_product(t, 1.0, driving);
    if (kept != 0.0) t += kept * detail::VolumeStress<Base>(base, f).tangent(f);
    return t;
  }
  bool admits(const Tensor3<double>& f) const noexcept { return base.admits(f) && determinant(f) > 0.0; }
  /// That of the base: relaxation scales its stress.
  bool is_beyond_range(const Tensor3<double>& f) const noexcept { return detail::is_beyond_range(base, f); }
};

/// A viscoelastic material: the stress right after a sudden strain is that of the base, and a share g_i of it relaxes
/// as exp(-t / tau_i). Over a step dt, with S0 the stress of the base (Simo 1987; Simo and Hughes 1998, 10.3):
///   h_i' = exp(-dt / tau_i) h_i + g_i (1 - exp(-dt / tau_i)) tau_i / dt (S0' - S0),
///   S = (1 - sum g_i) S0' + sum h_i',
/// exact if S0 is linear in time over the step and stable for every dt >= 0. dt = 0 is a sudden strain, an infinite dt
/// gives full relaxation. Parameters of the base are the instantaneous ones; the long-term ones are 1 - sum g_i times
/// these. Admissible: base admissible, g_i >= 0, their sum below 1, tau_i > 0. At large strain S is F^-1 P, which needs
/// J > 0 for every base. With deviatoric relaxation the part that does not relax is the stress of a pure change of
/// volume, that of the base at J^(1/3) I. So the long-term stress still derives from an energy, and no closed path
/// releases any. For a base whose energy splits into isochoric and volumetric parts it is the pressure, unchanged.
template <Material Base, int Terms>
struct Viscoelastic {
  Base base{};
  std::array<PronyTerm, Terms> terms{};
  Relaxation relaxation = Relaxation::deviatoric;
  double density = base.density;  ///< rho at rest [kg/m^3]; by default that of the base

  using SmallStrainHistory = StressHistory<Vector6, Terms>;
  using LargeStrainHistory = StressHistory<Tensor3<double>, Terms>;

  /// Share of the stress that remains after a long time [-].
  double long_term_share() const noexcept {
    double left = 1.0;
    for (const PronyTerm& t : terms) left -= t.share;
    return left;
  }
  /// Its share is the factor for the tangent of the base (for its deviatoric part only, with deviatoric relaxation).
  detail::PronyStep<Terms> over(double dt) const noexcept {
    detail::PronyStep<Terms> step;
    step.share = long_term_share();
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double x = dt / terms[i].relaxation_time;
      step.decay[i] = std::exp(-x);
      step.gain[i] = terms[i].share * detail::mean_decay(x);
      step.share += step.gain[i];
    }
    return step;
  }
  /// Stress [Pa] at the end of a step dt [s] that ends at this small strain (Voigt order); advances the history.
  Vector6 stress(const Vector6& strain, SmallStrainHistory& history,
                 double dt) const noexcept requires LinearMaterial<Base> {
    Vector6 fading = base.elasticity() * strain, kept = Vector6::Zero();
    if (relaxation == Relaxation::deviatoric) {
      kept.head<3>().setConstant(fading.head<3>().sum() / 3.0);
      fading -= kept;
    }
    return kept + advance(fading, history, over(dt));
  }

  /// First Piola-Kirchhoff stress [Pa] at the end of a step dt [s] that ends at F; advances the history.
  Tensor3<double> stress(const Tensor3<double>& f, LargeStrainHistory& history,
                         double dt) const noexcept requires HyperelasticMaterial<Base> {
    const Tensor3<double> p = material_of_step(over(dt), driving_stress(history, over(dt))).stress(f);
    update_history(f, history, over(dt));
    return p;
  }

  // The same in separate functions, for bodies: within a step the material is hyperelastic.

  /// The part of S [Pa] at the end of the step that comes from the history before the step.
  static Tensor3<double> driving_stress(const LargeStrainHistory& history,
                                        const detail::PronyStep<Terms>& step) noexcept {
    Tensor3<double> sum{};
    for (std::size_t i = 0; i < step.decay.size(); ++i)
      sum = sum + (step.decay[i] * history.fading[i] - step.gain[i] * history.elastic);
    return sum;
  }
  /// The hyperelastic material of the step. Refers to this material.
  ViscousStep<Base> material_of_step(const detail::PronyStep<Terms>& step, const Tensor3<double>& driving)
      const noexcept requires HyperelasticMaterial<Base> {
    return {base, step.share, relaxation == Relaxation::deviatoric ? 1.0 - step.share : 0.0, driving};
  }
  /// Advances the history over a step that ends at F.
  void update_history(const Tensor3<double>& f, LargeStrainHistory& history,
                      const detail::PronyStep<Terms>& step) const noexcept requires HyperelasticMaterial<Base> {
    Tensor3<double> p = base.stress(f);
    if (relaxation == Relaxation::deviatoric) p = p - detail::VolumeStress<Base>(base, f).stress();
    const Tensor3<double> c = cofactor(f);
    advance((1.0 / determinant(f, c)) * (transpose(c) * p), history, step);
  }
  /// Instantaneous elasticity at small strain [Pa].
  Matrix6 rest_elasticity() const noexcept requires HyperelasticMaterial<Base> { return base.rest_elasticity(); }

  bool admits(const Tensor3<double>& f) const noexcept requires HyperelasticMaterial<Base> {
    return base.admits(f) && determinant(f) > 0.0;
  }

  std::optional<SetupProblem> check() const {
    Base with_density = base;
    with_density.density = density;
    if (auto problem = with_density.check()) return problem;
    for (const PronyTerm& t : terms) {
      if (!(t.share >= 0.0 && t.share < 1.0)) return problem("share of a Prony term", t.share, 1.0);
      if (!(std::isnormal(t.relaxation_time) && t.relaxation_time > 0.0))
        return problem("relaxation time", t.relaxation_time, 0.0);
    }
    if (!(long_term_share() > 0.0)) return problem("long-term share of the stress", long_term_share(), 0.0);
    return std::nullopt;
  }

 private:
  template <class Stress>
  Stress advance(const Stress& elastic, StressHistory<Stress, Terms>& history,
                 const detail::PronyStep<Terms>& step) const noexcept {
    const Stress change = elastic - history.elastic;
    Stress total = long_term_share() * elastic;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      Stress& h = history.fading[i];
      h = step.decay[i] * h + step.gain[i] * change;
      total = total + h;
    }
    history.elastic = elastic;
    return total;
  }

  static SetupProblem problem(const std::string& name, double value, double threshold) {
    return parameter_problem(SetupErrorKind::bad_argument, "the " + name, value, threshold,
                             "Shares are between 0 and 1 and sum to less than 1; times are positive, in s");
  }
};

// clang-format off
/// A large-strain viscoelastic material.
template <class M>
concept ViscousMaterial =
    Material<M> && requires(const M& m, const Tensor3<double>& f, typename M::LargeStrainHistory& history) {
      { m.update_history(f, history, m.over(0.0)) } noexcept;
      { m.material_of_step(m.over(0.0), f).energy(f) } noexcept -> std::same_as<double>;
    };
// clang-format on

}}  // namespace palpate
