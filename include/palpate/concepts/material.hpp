// What a material is.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <optional>

namespace palpate::inline PALPATE_ABI {

/// An aggregate of named parameters that can say whether they are admissible. `density` is in kg/m^3; `check()` returns
/// the problem or nothing and is called once per region at set-up.
template <class M>
concept Material = std::copyable<M> && requires(const M& m) {
  { m.density } -> std::convertible_to<double>;
  { m.check() } -> std::same_as<std::optional<SetupProblem>>;
};

/// A material with constant stiffness: `elasticity()` is the symmetric positive definite 6 x 6 matrix [Pa] in the order
/// of core/voigt.hpp. Laws: testing/material_laws.hpp.
template <class M>
concept LinearMaterial = Material<M> && requires(const M& m) {
  { m.elasticity() } -> FixedMatrix<6, 6>;
};

/// A linear material with fibres: `elasticity(fibre)` is its matrix where the fibres run along that unit vector. Used
/// where the mesh has fibre directions, `elasticity()` where it has none.
template <class M>
concept FibreMaterial = LinearMaterial<M> && requires(const M& m, const Vector3& fibre) {
  { m.elasticity(fibre) } -> FixedMatrix<6, 6>;
};

}  // namespace palpate::inline PALPATE_ABI
