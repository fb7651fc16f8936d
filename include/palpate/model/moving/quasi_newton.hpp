// Solver policy for tissue at large strain in real time: Implicit<QuasiNewton<>>.
#pragma once

#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/assembly/smoothed_tetrahedra.hpp>
#include <palpate/model/moving/detail/quasi_newton_motion.hpp>
#include <palpate/model/moving/moving_model.hpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// L-BFGS around the factor of a step at rest, which is computed at set-up; forces of Smoothed<Tet4> in scalar type S,
/// those of other elements in double. For hyperelastic materials. Use Smoothed<Tet4>, Tet10 or Hex20, which do not
/// lock. See QuasiNewtonMotion.
template <std::floating_point S = double>
struct QuasiNewton {};

namespace detail {

template <class S, HyperelasticMaterial M>
std::unique_ptr<EnergyForces> make_energy_forces(HyperelasticBody<Smoothed<Tet4>, M> body, const SetupLimits& limits) {
  using Force = SmoothedTetrahedra<M, S>;
  return std::make_unique<BatchedEnergyForces<Force, S>>(Force(body, limits));
}
template <class S, Element E, LargeStrainMaterial M>
std::unique_ptr<EnergyForces> make_energy_forces(HyperelasticBody<E, M> body, const SetupLimits& limits) {
  return std::make_unique<TangentEnergyForces>(std::make_unique<LargeStrain<E, M>>(std::move(body), limits),
                                               ViscousMaterial<M>);
}

}  // namespace detail

template <class S>
struct SolverTraits<Implicit<QuasiNewton<S>>> {
  using Parameters = QuasiNewtonParameters;

  template <class Body>
  static PreparedMotion make_motion(const Body&, const Scene&, const Parameters&, const SetupLimits&) {
    static_assert(sizeof(Body) == 0,
                  "palpate: QuasiNewton moves hyperelastic materials, for example NeoHookean; for linear ones take "
                  "Implicit<Newton<SparseCholesky>>");
    return {};
  }
  template <Element E, LargeStrainMaterial M>
  static PreparedMotion make_motion(HyperelasticBody<E, M> body, const Scene& scene, const Parameters& p,
                                    const SetupLimits& limits) {
    detail::refuse_initial_strains(scene);
    DeformableBody made = detail::body_with_mass(body.rest, scene, limits);
    BlockMatrix stiffness = assemble_stiffness<E>(body.rest, limits);
    auto forces = detail::make_energy_forces<S>(std::move(body), limits);
    auto motion =
        std::make_unique<QuasiNewtonMotion>(std::move(made), std::move(forces), std::move(stiffness), p, limits);
    PreparedMotion prepared;
    prepared.start = p.settle ? motion->settle() : VectorX(VectorX::Zero(motion->displacement().size()));
    prepared.motion = std::move(motion);
    return prepared;
  }
};

}}  // namespace palpate
