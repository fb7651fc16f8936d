// Relaxation: a law whose stress fades after a strain, by a Prony series.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/voigt.hpp>

#include <array>
#include <cmath>
#include <string>

namespace palpate::inline PALPATE_ABI {

/// One term of a Prony series: `share` of the stress fades with this time.
struct PronyTerm {
  double share = 0.0;            ///< g_i [-], of the stress right after a fast strain
  double relaxation_time = 0.0;  ///< tau_i [s]
};

/// What fades: the whole stress, or the part that changes the shape.
enum class Relaxation { whole_stress, shape_only };

/// What an integration point remembers: plain numbers, zero at rest. `Stress` is Vector6 at small strain and
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

/// A material with memory: the stress right after a fast strain is that of the base, and in time a share g_i of it
/// fades as exp(-t / tau_i). Over a step dt, with S0 the stress of the base (Simo 1987; Simo and Hughes 1998, 10.3):
///   h_i' = exp(-dt / tau_i) h_i + g_i (1 - exp(-dt / tau_i)) tau_i / dt (S0' - S0),   S = (1 - sum g_i) S0' + sum
///   h_i',
/// exact where S0 is linear in time over the step and stable for every dt >= 0; dt = 0 is a sudden strain.
/// Parameters of the base are the fast ones; slow ones are 1 - sum g_i times these. Admissible: base admissible,
/// g_i >= 0, their sum below 1, tau_i > 0. At large strain S is P turned back by F^-1, which needs J > 0 for every
/// base.
template <Material Base, int Terms>
struct Viscoelastic {
  Base base{};
  std::array<PronyTerm, Terms> terms{};
  Relaxation relaxation = Relaxation::whole_stress;
  double density = base.density;  ///< rho at rest [kg/m^3]; that of the base unless given

  using SmallStrainHistory = StressHistory<Vector6, Terms>;
  using LargeStrainHistory = StressHistory<Tensor3<double>, Terms>;

  /// What is left of the stress after a long time [-].
  double long_term_share() const noexcept {
    double left = 1.0;
    for (const PronyTerm& t : terms) left -= t.share;
    return left;
  }
  /// d stress / d stress of the base over a step [-]: what the tangent of the base is multiplied by (its part of shape,
  /// if only that relaxes).
  double tangent_share(double dt) const noexcept {
    double share = long_term_share();
    for (const PronyTerm& t : terms) share += t.share * mean_decay(dt / t.relaxation_time);
    return share;
  }

  /// Stress [Pa] at the end of a step dt [s] that ends at this small strain (Voigt order); moves the history on.
  Vector6 stress(const Vector6& strain, SmallStrainHistory& history,
                 double dt) const noexcept requires LinearMaterial<Base> {
    Vector6 fading = base.elasticity() * strain, kept = Vector6::Zero();
    if (relaxation == Relaxation::shape_only) {
      kept.head<3>().setConstant(fading.head<3>().sum() / 3.0);
      fading -= kept;
    }
    return kept + advance(fading, history, dt);
  }

  /// First Piola-Kirchhoff stress [Pa] at the end of a step dt [s] that ends at F; moves the history on. The part of
  /// shape is S - (S : C) C^-1 / 3, so that what is kept is a pressure in space.
  Tensor3<double> stress(const Tensor3<double>& f, LargeStrainHistory& history,
                         double dt) const noexcept requires HyperelasticMaterial<Base> {
    const Tensor3<double> c = cofactor(f), inverse = (1.0 / determinant(f, c)) * transpose(c), p = base.stress(f);
    Tensor3<double> fading = inverse * p, kept{};
    if (relaxation == Relaxation::shape_only) {
      kept = (contract(p, f) / 3.0) * (inverse * transpose(inverse));  // S : C = P : F
      fading = fading - kept;
    }
    return f * (kept + advance(fading, history, dt));
  }

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
  /// (1 - exp(-x)) / x
  static double mean_decay(double x) noexcept { return x > 0.0 ? -std::expm1(-x) / x : 1.0; }

  template <class Stress>
  Stress advance(const Stress& elastic, StressHistory<Stress, Terms>& history, double dt) const noexcept {
    const Stress change = elastic - history.elastic;
    Stress total = long_term_share() * elastic;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double x = dt / terms[i].relaxation_time;
      Stress& h = history.fading[i];
      h = std::exp(-x) * h + (terms[i].share * mean_decay(x)) * change;
      total = total + h;
    }
    history.elastic = elastic;
    return total;
  }

  static SetupProblem problem(const char* name, double value, double threshold) {
    SetupProblem p;
    p.kind = SetupErrorKind::bad_argument;
    p.what = "the " + std::string(name) + " is " + number(value);
    p.hint = "Shares lie between 0 and 1 and sum to less than 1; times are positive, in s";
    p.value = value;
    p.threshold = threshold;
    return p;
  }
};

}  // namespace palpate::inline PALPATE_ABI
