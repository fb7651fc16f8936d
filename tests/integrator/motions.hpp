// Bodies and initial states for motion tests.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/element_frequency.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <Eigen/Geometry>

#include "assembly/bodies.hpp"

namespace test {

inline const NeoHookean soft{.youngs_modulus = 3e3, .poisson_ratio = 0.45, .density = 1000.0};

inline HyperelasticBody<Tet4, NeoHookean> soft_block(int n, NeoHookean material = soft) {
  return make_hyperelastic_body<Tet4, NeoHookean>(box_tet4(Vector3(0.1, 0.1, 0.1), {n, n, n}, BoxSplit::six),
                                                  std::vector<NeoHookean>{material});
}

/// All dofs of the nodes for which is_free(position) is true.
template <Element E, class IsFree>
std::vector<Index> dofs_where(const Mesh<E>& mesh, IsFree is_free) {
  std::vector<Index> dofs;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (is_free(mesh.position(i)))
      for (Index c = 0; c < 3; ++c) dofs.push_back(3 * i + c);
  return dofs;
}
template <Element E>
std::vector<Index> all_dofs(const Mesh<E>& mesh) {
  return dofs_where(mesh, [](const Vector3&) { return true; });
}
template <Element E>
std::vector<Index> above_ground(const Mesh<E>& mesh) {
  return dofs_where(mesh, [](const Vector3& p) { return p.z() > 1e-9; });
}

template <class Scheme, class S = double>
using NeoHookeanMotion = ExplicitMotion<BatchedTetrahedra<NeoHookean, S>, Scheme>;

template <class Scheme, class S = double>
NeoHookeanMotion<Scheme, S> motion_of(const HyperelasticBody<Tet4, NeoHookean>& body, const std::vector<Index>& free,
                                      const ExplicitOptions& options = {}) {
  return {BatchedTetrahedra<NeoHookean, S>(body), lumped_mass(body.rest), free, element_frequency_bound(body.rest),
          options};
}

/// Linear [kg m/s] and angular [kg m^2/s] momentum, about the origin.
struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};
template <Element E>
Momenta momenta(const Mesh<E>& mesh, const MotionState& s) {
  Momenta m;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vector3 p = s.mass[3 * i] * s.velocity.segment<3>(3 * i);
    m.linear += p;
    m.angular += (mesh.position(i) + s.displacement.segment<3>(3 * i)).cross(p);
  }
  return m;
}

/// A velocity of every node [m/s].
template <Element E>
VectorX velocity_field(const Mesh<E>& mesh, const std::function<Vector3(const Vector3&)>& v) {
  VectorX result(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) result.segment<3>(3 * i) = v(mesh.position(i));
  return result;
}

}  // namespace test
