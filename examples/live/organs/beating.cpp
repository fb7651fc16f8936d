// Dynamics by explicit steps: no matrix, no factorisation; inertia and loads that change with time.
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/own_types.hpp>

#include "../core/organ_of.hpp"

namespace live {

std::unique_ptr<Organ> make_beating(const TouchScene& scene, const Tuning& tuning) {
  using Model = HapticFEModel<Tet4, NeoHookean, Explicit<CentralDifference>>;
  return std::make_unique<OrganOf<Model, false>>(scene, scene.mesh, tuned_conditions(scene, tuning),
                                                 materials_of<NeoHookean>(scene, tuning), setup_options(tuning, false),
                                                 ExplicitParameters{.step = 4e-3, .mass_damping = 20.0});
}

}  // namespace live
