// A deliberate break for every law of materials at large strain.
#include <palpate/material/detail/material_range.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using testing::hyperelastic_material_laws;
using testing::violates;

namespace {

enum class Break {
  none,
  energy_at_rest,
  prestress,
  energy_halved,
  tangent,
  skew_tangent,
  turns_with_space,
  direction,
  single,
  lanes,
  single_lanes,
  admits_all,
  admits_nothing,
  small_strain,
  always_beyond
};

/// The neo-Hookean material with one defect.
template <Break wrong, class Law = NeoHookean>
struct Wrong : Law {
  template <class S>
  S energy(const Tensor3<S>& f) const noexcept {
    const S w = Law::energy(f), modulus = S(static_cast<detail::scalar_of<S>>(this->youngs_modulus));
    if constexpr (wrong == Break::energy_at_rest) return w + S(1e-9f) * modulus;
    if constexpr (wrong == Break::energy_halved) return S(0.5f) * w;
    if constexpr (wrong == Break::turns_with_space) return w + S(1e-6f) * modulus * f(0, 1) * f(0, 1);
    if constexpr (wrong == Break::direction) {
      const S fibre = dot(column(f, 0), column(f, 0)) - S(1);
      return w + S(1e-6f) * modulus * fibre * fibre;
    }
    return w;
  }
  template <class S>
  Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    Tensor3<S> p = Law::stress(f);
    const S modulus = S(static_cast<detail::scalar_of<S>>(this->youngs_modulus));
    constexpr bool one = sizeof(S) == sizeof(detail::scalar_of<S>), single = sizeof(detail::scalar_of<S>) == 4;
    const bool off = (wrong == Break::single && one && single) || (wrong == Break::lanes && !one && !single) ||
                     (wrong == Break::single_lanes && !one && single);
    if (off) p.e[5] = S(1.01f) * p.e[5];
    if constexpr (wrong == Break::prestress) p.e[0] = p.e[0] + S(1e-9f) * modulus;
    if constexpr (wrong == Break::turns_with_space) p(0, 1) = p(0, 1) + S(2e-6f) * modulus * f(0, 1);
    if constexpr (wrong == Break::direction) {
      const S slope = S(4e-6f) * modulus * (dot(column(f, 0), column(f, 0)) - S(1));
      for (int i = 0; i < 3; ++i) p(i, 0) = p(i, 0) + slope * f(i, 0);
    }
    return p;
  }
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    Matrix9 t = Law::tangent(f);
    if constexpr (wrong == Break::tangent) t(4, 4) *= 1.0 + 1e-6;
    if constexpr (wrong == Break::skew_tangent) t(2, 5) += 1e-6 * this->youngs_modulus;
    return t;
  }
  bool admits(const Tensor3<double>& f) const noexcept {
    if (wrong == Break::admits_all) return true;
    return wrong != Break::admits_nothing && Law::admits(f);
  }
  bool is_beyond_range(const Tensor3<double>& f) const noexcept {
    return wrong == Break::always_beyond || palpate::detail::is_beyond_range(static_cast<const Law&>(*this), f);
  }
  Matrix6 rest_elasticity() const noexcept {
    return (wrong == Break::small_strain ? 1.0 + 1e-9 : 1.0) * Law::rest_elasticity();
  }
};

template <Break wrong, class Law = NeoHookean>
testing::Violations broken() {
  return hyperelastic_material_laws(Wrong<wrong, Law>{{5e3, 0.45, 1060.0}});
}

/// St Venant-Kirchhoff that wrongly claims to survive inversion.
struct Boasting : StVenantKirchhoff {
  static constexpr bool survives_inversion = true;
  bool admits(const Tensor3<double>& f) const noexcept { return all_finite(f); }
};
/// The neo-Hookean material with J in a denominator.
struct Singular : NeoHookean {
  template <class S>
  Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    const S j = determinant(f);
    return (j / j) * NeoHookean::stress(f);
  }
};

}  // namespace

TEST_CASE("hyperelastic material laws can fail", "[testing][material][large]") {
  CHECK(testing::describe(broken<Break::none>()) == "");
  CHECK(violates(broken<Break::energy_at_rest>(), "no energy at rest"));
  CHECK(violates(broken<Break::prestress>(), "no stress at rest"));
  CHECK(violates(broken<Break::energy_halved>(), "stress is the derivative of the energy"));
  CHECK(violates(broken<Break::tangent>(), "tangent is the derivative of the stress"));
  CHECK(violates(broken<Break::skew_tangent>(), "tangent is symmetric"));
  CHECK(violates(broken<Break::turns_with_space>(), "objectivity"));
  CHECK(violates(broken<Break::direction>(), "isotropy"));
  CHECK_FALSE(violates(broken<Break::direction>(), "objectivity"));
  CHECK(violates(broken<Break::small_strain>(), "small strain"));
  CHECK(violates(broken<Break::single>(), "float equals double"));
  CHECK(violates(broken<Break::lanes>(), "lanes equal one"));
  CHECK(violates(broken<Break::single_lanes>(), "lanes of float equal double"));
  CHECK(violates(broken<Break::admits_all>(), "refuses what is not finite"));
  CHECK(violates(broken<Break::admits_all, StVenantKirchhoff>(), "refuses J <= 0"));
  CHECK(violates(broken<Break::admits_nothing>(), "holds at moderate strain"));
  CHECK(violates(broken<Break::admits_nothing>(), "holds everywhere"));
  CHECK(violates(broken<Break::always_beyond>(), "is within its range near rest"));
  CHECK(violates(broken<Break::always_beyond>(), "is within its range above its volume ratio"));
  CHECK(violates(hyperelastic_material_laws(NeoHookean{5e3, 0.5, 0.0}), "check accepts"));
}

TEST_CASE("laws of collapse can fail", "[testing][material][large]") {
  CHECK(violates(hyperelastic_material_laws(Boasting{{5e3, 0.3, 0.0}}), "pushes back"));
  CHECK(violates(hyperelastic_material_laws(Singular{{5e3, 0.3, 0.0}}), "is finite everywhere"));
  CHECK(
      violates(hyperelastic_material_laws(NeoHookean{5e3, 0.3, 0.0}, {.barrier = true}), "energy grows without bound"));
  CHECK(violates(hyperelastic_material_laws(NeoHookean{-5e3, 0.3, 0.0}), "energy is positive"));
}
