// Concepts of materials.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// An inadmissible parameter of a material as a SetupProblem; `what` names the parameter.
SetupProblem parameter_problem(SetupErrorKind kind, const std::string& what, double value, double threshold,
                               const char* hint);

/// An aggregate of named parameters that can check whether they are admissible. `density` is in kg/m^3. `check()`
/// returns the problem, or nothing; it is called once per region at set-up.
template <class M>
concept Material = std::copyable<M> && requires(const M& m) {
  { m.density } -> std::convertible_to<double>;
  { m.check() } -> std::same_as<std::optional<SetupProblem>>;
};

/// One material per region, by name; the name `everywhere` applies to all regions that are not named.
template <Material M>
using RegionMaterials = std::vector<std::pair<std::string, M>>;

/// A material with constant stiffness: `elasticity()` is the symmetric positive definite 6 x 6 matrix [Pa] in the order
/// of core/voigt.hpp. Laws: testing/material_laws.hpp.
template <class M>
concept LinearMaterial = Material<M> && requires(const M& m) {
  { m.elasticity() } -> FixedMatrix<6, 6>;
};

/// A linear material with fibres: `elasticity(fibre)` is its matrix for fibres along that unit vector. It is used where
/// the mesh has fibre directions; `elasticity()` is used where it has none.
template <class M>
concept FibreMaterial = LinearMaterial<M> && requires(const M& m, const Vector3& fibre) {
  { m.elasticity(fibre) } -> FixedMatrix<6, 6>;
};

/// A material for large strains, given by its stored energy. F is the deformation gradient.
///   energy(F) -> S             W [J per m^3 of rest volume], zero at rest
///   stress(F) -> Tensor3<S>    P = dW/dF, the first Piola-Kirchhoff stress [Pa]; S is double, float or Lanes of them
///   tangent(F) -> Matrix9      dP/dF [Pa], symmetric; row i + 3 j is P_ij, column k + 3 l is F_kl
///   rest_elasticity()          the 6 x 6 matrix of the same material at small strain [Pa]. Not called `elasticity`, so
///                              that such a material cannot be used as a linear one by mistake.
///   admits(F) -> bool          whether the material is valid at F. If not, the other functions may return anything.
///   survives_inversion         whether it is valid at singular and inverted F (J <= 0); otherwise J > 0 is required.
/// A material may have `is_beyond_range(F) -> bool`: whether it admits F and yet describes no solid there, because it
/// yields to compression or is not strongly elliptic. Without it that follows from the tangent, where F is clearly
/// deformed. With `range_volume_ratio() -> double`, a J above which no F is beyond the range, the check costs next to
/// nothing. These functions do not allocate or throw. Laws: testing/hyperelastic_laws.hpp.
template <class M>
concept HyperelasticMaterial =
    Material<M> && requires(const M& m, const Tensor3<double>& f, const Tensor3<float>& single,
                            const Tensor3<Lanes<double, 8>>& lanes, const Tensor3<Lanes<float, 16>>& single_lanes) {
      requires std::same_as<std::remove_cvref_t<decltype(M::survives_inversion)>, bool>;
      { m.energy(f) } -> std::same_as<double>;
      { m.energy(single) } -> std::same_as<float>;
      { m.stress(f) } -> std::same_as<Tensor3<double>>;
      { m.stress(single) } -> std::same_as<Tensor3<float>>;
      { m.stress(lanes) } -> std::same_as<Tensor3<Lanes<double, 8>>>;
      { m.stress(single_lanes) } -> std::same_as<Tensor3<Lanes<float, 16>>>;
      { m.tangent(f) } -> FixedMatrix<9, 9>;
      { m.rest_elasticity() } -> FixedMatrix<6, 6>;
      { m.admits(f) } -> std::same_as<bool>;
    };

/// A hyperelastic material with fibres: the same functions with one more argument, the unit vector along the fibres at
/// rest. Used where the mesh has fibre directions.
template <class M>
concept FibreHyperelasticMaterial =
    HyperelasticMaterial<M> &&
    requires(const M& m, const Tensor3<double>& f, const Triple<double>& fibre, const Tensor3<Lanes<float, 16>>& lanes,
             const Triple<Lanes<float, 16>>& fibres) {
      { m.energy(f, fibre) } -> std::same_as<double>;
      { m.stress(f, fibre) } -> std::same_as<Tensor3<double>>;
      { m.stress(lanes, fibres) } -> std::same_as<Tensor3<Lanes<float, 16>>>;
      { m.tangent(f, fibre) } -> FixedMatrix<9, 9>;
      { m.rest_elasticity(fibre) } -> FixedMatrix<6, 6>;
      { m.admits(f, fibre) } -> std::same_as<bool>;
    };

inline SetupProblem parameter_problem(SetupErrorKind kind, const std::string& what, double value, double threshold,
                                      const char* hint) {
  SetupProblem p;
  p.kind = kind;
  p.what = what + " is " + number(value);
  p.hint = hint;
  p.value = value;
  p.threshold = threshold;
  return p;
}

}}  // namespace palpate

