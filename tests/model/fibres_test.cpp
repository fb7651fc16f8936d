// Fibres in a model and in the key of its cache.
#include <palpate/material/orthotropic.hpp>
#include <palpate/model/cache/detail/cache_key.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include "assembly/bodies.hpp"

using namespace test;

namespace {

const TransverselyIsotropic muscle{60e3, 12e3, 0.45, 0.6, 9e3, Vector3::UnitX(), 1060.0};

Mesh<Tet4> block_with_fibres() {
  Mesh<Tet4> mesh = box_tet4({0.03, 0.02, 0.02}, {3, 2, 2});
  testing::Random random(107);
  for (Index e = 0; e < mesh.element_count(); ++e) mesh.fibres.push_back(testing::random_rotation(random).col(0));
  return mesh;
}

}  // namespace

TEST_CASE("the cache of a body is rejected for other fibres", "[model][cache][fibres]") {
  const Mesh<Tet4> mesh = block_with_fibres();
  Scene scene;
  scene.fix("x0");
  const auto key_of = [&](const Body<Tet4>& body) {
    return detail::cache_key(detail::body_key(body), conditions_of(body.mesh, scene), {},
                             assemble_stiffness<Tet4>(body, {}), "policy", 8);
  };
  const detail::CacheKey key = key_of(make_body(mesh, muscle));
  std::string why;
  CHECK(detail::compare(key, key_of(make_body(mesh, muscle)), why) == CacheMismatch::none);
  Mesh<Tet4> rotated = mesh, swapped = mesh, without = mesh;
  rotated.fibres[5] = mesh.fibres[6];
  std::swap(swapped.fibres[2], swapped.fibres[3]);
  without.fibres.clear();
  for (const Mesh<Tet4>& other : {rotated, swapped, without})
    CHECK(detail::compare(key, key_of(make_body(other, muscle)), why) == CacheMismatch::material);
}

TEST_CASE("a model with fibres agrees with the equilibrium of its assembled parts", "[model][fibres]") {
  const Mesh<Tet4> mesh = block_with_fibres();
  Scene scene;
  scene.fix("x0").touch("x1").gravity({0, 0, -9.81}).expand(everywhere, 0.01);
  using Model = HapticFEModel<Tet4, TransverselyIsotropic, Condensed<SelectiveInverse>>;
  const Model model(mesh, scene, muscle);
  Body<Tet4> body = make_body(mesh, muscle);
  body.initial_strain = detail::initial_strains_by_region(mesh, scene);
  VectorX force(3 * mesh.node_count()), weight = detail::initial_strain_load(body);
  assemble_stiffness<Tet4>(body, {}).apply(model.displacement(), force);
  const VectorX mass = nodal_mass(body);
  for (Index i = 0; i < mass.size(); ++i) weight[3 * i + 2] -= 9.81 * mass[i];
  const EssentialConditions conditions = conditions_of(mesh, scene);
  VectorX out_of_balance(conditions.free_count());
  conditions.gather(force - weight, out_of_balance);
  CHECK(out_of_balance.norm() <= 1e-9 * weight.norm());

  Mesh<Tet4> spoilt = mesh;
  spoilt.fibres[4].setZero();
  CHECK(refusal([&] { Model(spoilt, scene, muscle); }).ids == std::vector<std::int64_t>{4});
  Mesh<Tet4> rotated = mesh;
  for (Vector3& f : rotated.fibres) f = Vector3::UnitY();
  CHECK((Model(rotated, scene, muscle).displacement() - model.displacement()).norm() >
        0.01 * model.displacement().norm());
}
