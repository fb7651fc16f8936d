// Large strain in real time: a step in the background every 16 ms, the contact in every tick.
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/own_types.hpp>

#include "../core/organ_of.hpp"

namespace live {

std::unique_ptr<Organ> make_quasi_newton(const TouchScene& scene, const Tuning& tuning) {
  using Model = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;
  return std::make_unique<OrganOf<Model, false>>(scene, scene.mesh, tuned_conditions(scene, tuning),
                                                 materials_of<NeoHookean>(scene, tuning), setup_options(tuning, false),
                                                 QuasiNewtonParameters{.step = 0.016, .inertia = false});
}

}  // namespace live
