// Compositions at large strain.
#pragma once

#include <palpate/c/detail/composed_tissue.hpp>
#include <palpate/c/detail/policies.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/model/haptic_fe_model.tpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

inline QuasiNewtonParameters quasi_newton_parameters(const MotionInput& motion) {
  QuasiNewtonParameters parameters;
  if (motion.step != 0.0) parameters.step = motion.step;  // not above zero: the set-up refuses what is below
  parameters.inertia = !motion.quasi_static;
  parameters.mass_damping = motion.mass_damping;
  return parameters;
}

template <class Law>
RegionMaterials<Law> materials_of(const RegionMaterials<LinearElastic>& given) {
  RegionMaterials<Law> materials;
  for (const auto& [region, m] : given)
    materials.emplace_back(region, Law{m.youngs_modulus, m.poisson_ratio, m.density});
  return materials;
}

/// A tissue on a mesh of `Given`, an element with the same nodes. `Touched` is the base that a servo sees.
template <class E, class Given, class Solver, class Touched>
std::unique_ptr<AnyTissue> make_moving(const TissueInput& input) {
  using Model = HapticFEModel<E, NeoHookean, Solver>;
  return std::make_unique<ComposedTissue<Model, Touched>>(mesh_of<Given>(input.mesh), input.scene,
                                                          materials_of<NeoHookean>(input.materials), input.options,
                                                          quasi_newton_parameters(input.motion));
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
