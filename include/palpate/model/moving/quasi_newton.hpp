// Solver policy for tissue at large strain in real time: Implicit<QuasiNewton<>>.
#pragma once

#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/assembly/smoothed_tetrahedra.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/model/detail/touchable.hpp>
#include <palpate/model/moving/detail/partly_linear_motion.hpp>
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
                  "Implicit<Newton>");
    return {};
  }
  template <Element E, LargeStrainMaterial M>
  static PreparedMotion make_motion(HyperelasticBody<E, M> body, const Scene& scene, const Parameters& p,
                                    const SetupLimits& limits) {
    detail::refuse_initial_strains(scene);
    DeformableBody made = detail::body_with_mass(body.rest, scene, limits);
    if (p.large_strain_within != infinity) {
      p.require_divisible(ViscousMaterial<M>);
      const MeshRef mesh = mesh_ref(body.rest.mesh);
      const std::vector<NodeId> touched =
          detail::resolve_touchable(mesh, extract_boundary<E>(body.rest.mesh), scene).nodes;
      if (detail::BodyParts parts = detail::divide_body(mesh, touched, p.large_strain_within);
          !parts.far_part.elements.empty())
        return make_partly_linear(body, std::move(made), std::move(parts), p, limits);
    }
    BlockMatrix stiffness = assemble_stiffness<E>(body.rest, limits);
    auto factor = std::make_shared<detail::RenewableFactor>(made, std::move(stiffness), std::vector<NodeId>{},
                                                            stiffness_of_shape(body.rest, p), limits);
    auto motion = std::make_unique<detail::QuasiNewtonMotion>(
        std::move(made), detail::make_energy_forces<S>(std::move(body), limits), std::move(factor), p);
    motion->begin();
    PreparedMotion prepared;
    prepared.large_strain = true;
    prepared.start = motion->displacement();
    prepared.motion = std::move(motion);
    return prepared;
  }

 private:
  /// The stiffness of linear elasticity on the displaced mesh.
  template <Element E>
  static detail::StiffnessAt stiffness_of_shape(const Body<E>& rest, const Parameters& p) {
    if (!p.renew_factor) return {};
    return [body = rest, rest = rest.mesh.positions](const VectorX& u, BlockMatrix& k) mutable {
      for (std::size_t i = 0; i < rest.size(); ++i)
        body.mesh.positions[i] = rest[i] + node_vector(u, static_cast<Index>(i));
      for (Index e = 0; e < body.mesh.element_count(); ++e)
        if (!(element_shape<E>(element_nodes<E>(body.mesh, e)).relative_volume > 0.0)) return false;
      k.copy_values(assemble_stiffness<E>(body, SetupLimits{}));
      return true;
    };
  }
  template <Element E, LargeStrainMaterial M>
  static PreparedMotion make_partly_linear(const HyperelasticBody<E, M>& body, DeformableBody made,
                                           detail::BodyParts parts, const Parameters& p, const SetupLimits& limits) {
    detail::require_mass(made);
    std::unique_ptr<detail::LinearSurroundings> surroundings;
    {
      const OriginalIds ids = parts.far_part.original_ids();
      const ScopedIdTranslation translation(ids);
      const Body<E> far_body = detail::part_of(body.rest, parts.far_part);
      surroundings = std::make_unique<detail::LinearSurroundings>(
          assemble_stiffness<E>(far_body, limits), detail::conditions_of(parts.far_part, made.conditions),
          far_body.mesh.positions, parts.interface_in(parts.far_part), limits);
    }
    const OriginalIds ids = parts.near_part.original_ids();
    const ScopedIdTranslation translation(ids);
    HyperelasticBody<E, M> near_body = detail::part_of(body, parts.near_part);
    const BlockMatrix stiffness = assemble_stiffness<E>(near_body.rest, limits);
    const detail::BlockPattern pattern = detail::block_pattern(near_body.rest.mesh);
    detail::StiffnessAt stiffness_at = stiffness_of_shape(near_body.rest, p);
    return detail::prepare_partly_linear(std::move(made), std::move(parts), pattern, stiffness, std::move(stiffness_at),
                                         detail::make_energy_forces<S>(std::move(near_body), limits),
                                         std::move(surroundings), p, limits);
  }
};

}}  // namespace palpate
