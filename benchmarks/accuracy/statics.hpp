// Static solution of a body without a haptic model.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <chrono>

namespace accuracy {

using namespace palpate;

/// One material per region; the last is used for all further regions. No initial strain.
template <Element E>
Body<E> body_of(Mesh<E> mesh, std::vector<LinearElastic> materials) {
  materials.resize(mesh.region_names.size(), LinearElastic(materials.back()));
  return make_body(std::move(mesh), materials);
}

/// Displacement and forces of a static state, 3 per node.
struct Solved {
  VectorX displacement;  ///< [m]
  VectorX reactions;     ///< of the supports, zero on free dofs [N]
  double seconds = 0.0;  ///< time of assembly and factorisation
};

/// K_ff^-1 applied to the free part of `load`; the result has all dofs, zero on prescribed ones. By SparseCholesky
/// (solver.cpp: compiled once).
VectorX solve_free(const BlockMatrix& k, const EssentialConditions& conditions, const std::vector<Vector3>& positions,
                   const VectorX& load, double& seconds);

/// Solves a scene; `more_load` [N] is added to its loads.
template <Element E>
Solved solve_static(const Body<E>& body, const Scene& scene, const VectorX& more_load = {}) {
  const auto boundary = extract_boundary<E>(body.mesh);
  const EssentialConditions conditions = resolve_essential(body.mesh, boundary, scene);
  VectorX load = detail::applied_load(body, boundary, scene) + detail::initial_strain_load(body);
  if (more_load.size() > 0) load += more_load;
  if (!scene.gravity().isZero(0.0)) {
    const VectorX mass = nodal_mass(body);
    for (Index i = 0; i < mass.size(); ++i) load.segment<3>(3 * i) += mass[i] * scene.gravity();
  }
  Solved s;
  const auto start = std::chrono::steady_clock::now();
  const BlockMatrix k = assemble_stiffness<E>(body, {});
  s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  VectorX force(load.size());
  k.apply(conditions.prescribed, force);
  double factorisation = 0.0;
  s.displacement = solve_free(k, conditions, body.mesh.positions, load - force, factorisation) + conditions.prescribed;
  s.seconds += factorisation;
  k.apply(s.displacement, force);
  s.reactions = force - load;
  for (const Index dof : conditions.free_dofs) s.reactions[dof] = 0.0;
  return s;
}

/// Mean displacement of a loaded group in the direction of a dead traction: twice the energy over the force.
template <Element E>
double mean_displacement(const Body<E>& body, const Scene& scene, const Solved& solved, double total_force) {
  return detail::applied_load(body, extract_boundary<E>(body.mesh), scene).dot(solved.displacement) / total_force;
}

}  // namespace accuracy
