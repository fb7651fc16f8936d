#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include <functional>

#include "catch.hpp"
#include "refused.hpp"

namespace test {

using namespace palpate;

inline const LinearElastic liver{5e3, 0.45, 1060.0};
/// The material of the reference matrices of the two cubes.
inline const LinearElastic reference_material{1000.0, 0.3, 1.0};

/// One material per region, the last one for all remaining regions; no initial strain.
template <Element E>
Body<E> body_of(Mesh<E> mesh, std::vector<LinearElastic> materials) {
  materials.resize(mesh.region_names.size(), LinearElastic(materials.back()));
  return make_body(std::move(mesh), materials);
}

/// Moves every node by up to `amount`, except those on the faces of the box [0, size].
inline Mesh<Tet4> jittered(Mesh<Tet4> mesh, double amount, const Vector3& size) {
  testing::Random random(1729);
  for (Vector3& x : mesh.positions) {
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside = inside && x[i] > 1e-9 * size[i] && x[i] < (1 - 1e-9) * size[i];
    const Vector3 step = random.vector<3>(-amount, amount);
    if (inside) x += step;
  }
  return mesh;
}

/// Conditions of a scene on a whole body.
template <Element E>
EssentialConditions conditions_of(const Mesh<E>& mesh, const Scene& scene) {
  return resolve_essential(mesh, extract_boundary<E>(mesh), scene);
}

}  // namespace test
