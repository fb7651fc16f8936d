// The measurements of the program.
#pragma once

#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/element_frequency.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>
#include <palpate/material/neo_hookean.hpp>

#include "../common/bodies.hpp"
#include "../common/row.hpp"
#include "../common/timing.hpp"

namespace explicit_path {

using namespace palpate;

inline const NeoHookean soft{.youngs_modulus = 3e3, .poisson_ratio = 0.45, .density = 1000.0};

inline HyperelasticBody<Tet4, NeoHookean> soft_block(int n) {
  return make_hyperelastic_body<Tet4, NeoHookean>(bench::standard_block(n).mesh, std::vector<NeoHookean>{soft});
}
inline std::vector<Index> free_dofs(const Mesh<Tet4>& mesh, double above) {
  std::vector<Index> dofs;
  for (Index dof = 0; dof < 3 * mesh.node_count(); ++dof)
    if (mesh.position(dof / 3).z() > above) dofs.push_back(dof);
  return dofs;
}

template <class Scheme, class S = double>
ExplicitMotion<BatchedTetrahedra<NeoHookean, S>, Scheme> motion_of(const HyperelasticBody<Tet4, NeoHookean>& body,
                                                                   double free_above,
                                                                   const ExplicitOptions& options = {}) {
  return {BatchedTetrahedra<NeoHookean, S>(body), lumped_mass(body.rest), free_dofs(body.rest.mesh, free_above),
          element_frequency_bound(body.rest), options};
}

/// Force per element: batches compared with a plain loop over elements.
void measure_force(bench::RowFile& rows, int n);
/// One second of motion of a body with n cells per side.
void measure_real_time(bench::RowFile& rows, int n);
/// Drift of the conserved quantities of a free block over a million steps.
void measure_drift(bench::RowFile& rows);
/// Blocks with all nodes displaced at random.
void measure_scrambles(bench::RowFile& rows, int runs);

}  // namespace explicit_path
