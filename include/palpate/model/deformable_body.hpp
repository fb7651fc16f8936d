// A body with its conditions, ready for statics or dynamics.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/assembly/viscous_forces.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/mesh/detail/mechanisms.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {
/// Forces, conditions, loads and mass of a body, independent of its elements and materials. Vectors have 3 entries per
/// node.
struct DeformableBody {
  std::unique_ptr<ElasticForces> elastic;
  EssentialConditions conditions;
  VectorX load;             ///< dead loads, gravity included [N]
  detail::MassMatrix mass;  ///< consistent; empty in a body for statics
  VectorX lumped;           ///< mass per node [kg]; empty in a body for statics
  detail::BlockPattern pattern;
  std::vector<Vector3> positions;  ///< at rest [m]
};

namespace detail {

/// Diagonal of the bounding box of a body [m].
inline double extent(const std::vector<Vector3>& positions) {
  return box_of(positions).size().norm();
}

/// Throws bad_density when a free node has no mass.
inline void require_mass(const DeformableBody& body) {
  for (Index i = 0; i < body.lumped.size(); ++i)
    if (!(body.lumped[i] > 0.0) && body.conditions.constrained[static_cast<std::size_t>(i)] != 7)
      raise_at(SetupIds::nodes, i, SetupErrorKind::bad_density, "a node has no mass",
               "Give every region a density in kg/m^3");
}

/// Everything except the forces and the mass.
template <Element E>
DeformableBody body_without_mass(const Body<E>& rest, const Scene& scene) {
  DeformableBody body;
  const auto boundary = extract_boundary<E>(rest.mesh);
  body.conditions = resolve_essential(rest.mesh, boundary, scene);
  body.load = applied_load(rest, boundary, scene);
  if (!scene.gravity().isZero(0.0)) {
    const VectorX mass = nodal_mass(rest);
    for (Index i = 0; i < mass.size(); ++i) add_node_vector(body.load, i, mass[i] * scene.gravity());
  }
  if (!all_finite(body.load)) raise(SetupErrorKind::non_finite, "the loads are not finite");
  body.positions = rest.mesh.positions;
  return body;
}

template <Element E>
DeformableBody body_with_mass(const Body<E>& rest, const Scene& scene, const SetupLimits& limits) {
  DeformableBody body = body_without_mass(rest, scene);
  body.mass = assemble_mass(rest, limits);
  body.lumped = lumped_mass(rest);
  body.pattern = body.mass.pattern();
  return body;
}

template <Element E>
DeformableBody constrained_body_without_forces(const Body<E>& rest, const Scene& scene) {
  DeformableBody body = body_without_mass(rest, scene);
  require_constrained(rest.mesh, body.conditions.constrained);
  body.pattern = block_pattern(rest.mesh);
  return body;
}

inline void refuse_initial_strains(const Scene& scene) {
  if (!scene.initial_strains().empty())
    raise(SetupErrorKind::unsupported, "initial strains at large deformation or with viscoelasticity",
          "Use a linear material");
}

/// Makes a material body from a mesh and materials at large or small strain.
template <Element E, LargeStrainMaterial M>
auto make_any_body(Mesh<E> mesh, const RegionMaterials<M>& materials) {
  return make_hyperelastic_body(std::move(mesh), materials);
}
template <Element E, class M>
auto make_any_body(Mesh<E> mesh, const RegionMaterials<M>& materials) {
  return make_body(std::move(mesh), materials);
}

// The functions below do not check the geometry of a body (flat and inverted elements): make bodies from admitted
// meshes (mesh/admission.hpp). Equilibrium and HapticFEModel admit their meshes.

}  // namespace detail

/// A hyperelastic body in a scene. Throws the errors of assembly and conditions, and unsupported for initial strains.
template <Element E, LargeStrainMaterial M>
DeformableBody make_deformable_body(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {}) {
  detail::refuse_initial_strains(scene);
  DeformableBody made = detail::body_with_mass(body.rest, scene, limits);
  made.elastic = std::make_unique<LargeStrain<E, M>>(std::move(body), limits);
  return made;
}

/// The same for statics: without mass. Also throws unconstrained when the body can move rigidly in the scene.
template <Element E, LargeStrainMaterial M>
DeformableBody make_constrained_body(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {}) {
  detail::refuse_initial_strains(scene);
  DeformableBody made = detail::constrained_body_without_forces(body.rest, scene);
  made.elastic = std::make_unique<LargeStrain<E, M>>(std::move(body), limits);
  return made;
}

/// A body at small strain in a scene; initial strains become loads.
template <Element E>
DeformableBody make_deformable_body(Body<E> body, const Scene& scene, const SetupLimits& limits = {}) {
  static_assert(!detail::HasSmoothedStrain<E>,
                "palpate: the stiffness of a smoothed element has a different sparsity pattern than its mass");
  DeformableBody made = detail::body_with_mass(body, scene, limits);
  made.load += detail::initial_strain_load(body, detail::initial_strains_by_region(body.mesh, scene));
  made.elastic = std::make_unique<LinearForces>(assemble_stiffness<E>(body, limits));
  return made;
}

/// The same for statics, as above.
template <Element E>
DeformableBody make_constrained_body(Body<E> body, const Scene& scene, const SetupLimits& limits = {}) {
  static_assert(!detail::HasSmoothedStrain<E>,
                "palpate: for statics at small strain with smoothed elements use HapticFEModel");
  DeformableBody made = detail::constrained_body_without_forces(body, scene);
  made.load += detail::initial_strain_load(body, detail::initial_strains_by_region(body.mesh, scene));
  made.elastic = std::make_unique<LinearForces>(assemble_stiffness<E>(body, limits));
  return made;
}

/// A viscoelastic body at small strain. Also throws unsupported for initial strains, and the errors of ViscousForces.
template <Element E>
DeformableBody make_deformable_body(ViscousBody<E> body, const Scene& scene, const SetupLimits& limits = {}) {
  static_assert(!detail::HasSmoothedStrain<E>,
                "palpate: the stiffness of a smoothed element has a different sparsity pattern than its mass");
  detail::refuse_initial_strains(scene);
  DeformableBody made = detail::body_with_mass(body.fast, scene, limits);
  made.elastic = std::make_unique<detail::ViscousForces>(std::move(body), limits);
  return made;
}

/// The same for statics, as above.
template <Element E>
DeformableBody make_constrained_body(ViscousBody<E> body, const Scene& scene, const SetupLimits& limits = {}) {
  static_assert(!detail::HasSmoothedStrain<E>,
                "palpate: the stiffness of a smoothed element has a different sparsity pattern than its mesh");
  detail::refuse_initial_strains(scene);
  DeformableBody made = detail::constrained_body_without_forces(body.fast, scene);
  made.elastic = std::make_unique<detail::ViscousForces>(std::move(body), limits);
  return made;
}

}}  // namespace palpate
