// Growth and thermal expansion per region.
#include <palpate/assembly/load_vector.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/post/stress.hpp>

#include "assembly/bodies.hpp"
#include "mesh/two_cubes.hpp"

using namespace test;

namespace {

/// Displacement under the initial strains of a scene that constrains the body.
template <Element E>
VectorX solve(Body<E>& body, const Scene& scene) {
  const EssentialConditions conditions = conditions_of(body.mesh, scene);
  body.initial_strain = detail::initial_strains_by_region(body.mesh, scene);
  VectorX load(conditions.free_count()), answer(load.size()), u(conditions.dof_count());
  conditions.gather(detail::initial_strain_load(body), load);
  SparseCholesky(free_matrix(assemble_stiffness<E>(body, {}), conditions), {}).solve_into(load, answer);
  conditions.scatter(answer, u);
  return u;
}

}  // namespace

TEMPLATE_TEST_CASE("a statically determinate body expands without stress", "[assembly][expansion]", Tet4, Tet10, Hex8,
                   Hex20) {
  using E = TestType;
  const auto mesh = [] {
    if constexpr (E::nodes == 4) return box_tet4({0.3, 0.2, 0.1}, {3, 2, 1});
    if constexpr (E::nodes == 8) return box_hex8({0.3, 0.2, 0.1}, {3, 2, 1});
    if constexpr (E::nodes == 10) return box_tet10({0.3, 0.2, 0.1}, {3, 2, 1});
    if constexpr (E::nodes == 20) return box_hex20({0.3, 0.2, 0.1}, {3, 2, 1});
  }();
  Scene scene;  // planes of symmetry through the origin do not resist growth about it
  scene.prescribe("x0", {0.0, std::nullopt, std::nullopt});
  scene.prescribe("y0", {std::nullopt, 0.0, std::nullopt});
  scene.prescribe("z0", {std::nullopt, std::nullopt, 0.0});
  const TransverselyIsotropic muscle{60e3, 12e3, 0.45, 0.6, 9e3, Vector3(1, 2, 2) / 3.0, 1060.0};
  const auto check = [&](auto body, double elongation) {
    const VectorX u = solve(body, scene);
    for (Index i = 0; i < body.mesh.node_count(); ++i)
      CHECK((u.segment<3>(3 * i) - elongation * body.mesh.position(i)).norm() <= 1e-12 * std::abs(elongation));
    const double scale = body.elasticity.front().cwiseAbs().maxCoeff() * std::abs(elongation);
    CHECK(stress_field(body, u).elements.cwiseAbs().maxCoeff() <= 1e-10 * scale);
    CHECK(strain_energy(body, u) <= 1e-20 * scale);
  };
  scene.expand("body", 0.02);
  check(make_body(mesh, liver), 0.02);
  check(make_body(mesh, muscle), 0.02);
  scene.thermal_strain(everywhere, 2e-4, -150.0);  // sum: 0.02 - 0.03
  check(make_body(mesh, liver), -0.01);
}

TEST_CASE("growth of one region strains the other", "[assembly][expansion]") {
  // Two cubes clamped in x at both ends, on rollers elsewhere: a bar in which one half grows by e against E. Rollers
  // in y and z leave the lateral growth free only on average, so nu = 0 makes the closed form exact: sigma = -E e / 2.
  Mesh<Hex8> mesh = box_hex8({2, 1, 1}, {2, 1, 1});
  mesh.regions = {0, 1};
  mesh.region_names = {"left", "right"};
  Scene scene;
  scene.prescribe("surface", {std::nullopt, 0.0, 0.0})
      .prescribe("x0", {0.0, 0.0, 0.0})
      .prescribe("x1", {0.0, 0.0, 0.0});
  scene.expand("right", 0.01);
  Body<Hex8> body = make_body(mesh, LinearElastic{1000.0, 0.0, 1.0});
  const VectorX u = solve(body, scene);
  const StressColumns stress = stress_field(body, u).elements;
  for (Index e : {0, 1}) CHECK_THAT(stress(voigt::xx, e), Catch::Matchers::WithinRel(-5.0, 1e-12));
  CHECK_THAT(stress(voigt::yy, 0), Catch::Matchers::WithinAbs(0.0, 1e-12));
  CHECK_THAT(stress(voigt::yy, 1), Catch::Matchers::WithinRel(-10.0, 1e-12));  // fully constrained there
}

TEST_CASE("invalid expansions are refused", "[mesh][expansion]") {
  Scene scene;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_REFUSED(SetupErrorKind::non_finite, scene.expand(everywhere, nan));
  CHECK_REFUSED(SetupErrorKind::bad_argument, scene.expand(everywhere, -1.0));
  CHECK_REFUSED(SetupErrorKind::non_finite, scene.thermal_strain(everywhere, nan, 1.0));
  CHECK_REFUSED(SetupErrorKind::non_finite, scene.thermal_strain(everywhere, 1e-4, infinity));
  CHECK(scene.initial_strains().empty());
  scene.expand("nowhere", 0.01);
  CHECK_REFUSED(SetupErrorKind::unknown_group, detail::initial_strains_by_region(two_cubes(), scene));
}
