// A body with its conditions, ready for statics or dynamics.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/assembly/linear_forces.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/mesh/rigid_modes.hpp>

#include <memory>

namespace palpate::inline PALPATE_ABI {

/// What holds and moves a body, without its elements and laws. Vectors have 3 entries per node.
struct DeformableBody {
  std::unique_ptr<ElasticForces> elastic;
  EssentialConditions conditions;
  VectorX load;     ///< dead loads, gravity included [N]
  MassMatrix mass;  ///< consistent
  VectorX lumped;   ///< mass per node [kg]
  BlockPattern pattern;
  std::vector<Vector3> positions;  ///< at rest [m]
};

namespace detail {

template <Element E>
DeformableBody deformable_body(const Body<E>& rest, const Scene& scene, const SetupLimits& limits) {
  DeformableBody body;
  const auto boundary = extract_boundary<E>(rest.mesh);
  body.conditions = resolve_essential(rest.mesh, boundary, scene);
  body.load = applied_load(rest, boundary, scene);
  body.mass = assemble_mass(rest, limits);
  body.lumped = lumped_mass(rest);
  const VectorX mass = nodal_mass(rest);
  for (Index i = 0; i < mass.size(); ++i) body.load.template segment<3>(3 * i) += mass[i] * scene.gravity();
  if (!body.load.allFinite()) raise(SetupErrorKind::non_finite, "the loads are not finite");
  body.pattern = body.mass.pattern();
  body.positions = rest.mesh.positions;
  return body;
}

}  // namespace detail

/// A hyperelastic body in a scene. Throws what assembly and conditions throw, and unsupported for initial strains.
template <Element E, HyperelasticMaterial M>
DeformableBody make_deformable_body(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {}) {
  if (!scene.initial_strains().empty())
    raise(SetupErrorKind::unsupported, "initial strains at large deformation", "Use a linear material");
  DeformableBody made = detail::deformable_body(body.rest, scene, limits);
  made.elastic = std::make_unique<LargeStrain<E, M>>(std::move(body), limits);
  return made;
}

/// A body at small strain in a scene; initial strains become loads.
template <Element E>
DeformableBody make_deformable_body(Body<E> body, const Scene& scene, const SetupLimits& limits = {}) {
  static_assert(!HasSmoothedStrain<E>,
                "palpate: the stiffness of a smoothed element has another pattern than its mass");
  DeformableBody made = detail::deformable_body(body, scene, limits);
  made.load += initial_strain_load(body, initial_strains_by_region(body.mesh, scene));
  made.elastic = std::make_unique<LinearForces>(assemble_stiffness<E>(body, limits));
  return made;
}

}  // namespace palpate::inline PALPATE_ABI
