// Essential conditions, loads and masses of whole bodies.
#include <palpate/assembly/load_vector.hpp>

#include <Eigen/Geometry>

#include "assembly/bodies.hpp"
#include "assembly/csv.hpp"
#include "local/closed_form.hpp"
#include "mesh/two_cubes.hpp"

using namespace test;

namespace {

const Body<Tet4> cubes = body_of(two_cubes(), {reference_material});

VectorX load_of(const Scene& scene, const Body<Tet4>& body = cubes) {
  return detail::applied_load(body, extract_boundary<Tet4>(body.mesh), scene);
}
Vector3 total(const VectorX& f) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < f.size() / 3; ++i) sum += f.segment<3>(3 * i);
  return sum;
}
Vector3 total_moment(const VectorX& f, const Body<Tet4>& body = cubes) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < f.size() / 3; ++i) sum += body.mesh.position(i).cross(Vector3(f.segment<3>(3 * i)));
  return sum;
}

}  // namespace

TEST_CASE("free and prescribed dofs", "[assembly][conditions]") {
  Scene scene;
  scene.fix("fixed").prescribe("end", {0.1, std::nullopt, std::nullopt});
  const EssentialConditions c = conditions_of(cubes.mesh, scene);
  CHECK(c.dof_count() == 36);
  CHECK(c.free_count() == 36 - 12 - 4);
  CHECK(c.prescribed.sum() == 0.4);
  for (Index dof = 0; dof < 36; ++dof) {
    const Index free = c.free_index[static_cast<std::size_t>(dof)];
    CHECK(c.is_constrained(dof) == (free < 0));
    if (free >= 0) CHECK(c.free_dofs[static_cast<std::size_t>(free)] == dof);
    CHECK(c.is_constrained(dof) == (dof < 12 || (dof >= 24 && dof % 3 == 0)));
  }
  const VectorX full = VectorX::LinSpaced(36, 1.0, 36.0);
  VectorX part(c.free_count()), back(36);
  c.gather(full, part);
  c.scatter(part, back);
  for (Index dof = 0; dof < 36; ++dof) CHECK(back[dof] == (c.is_constrained(dof) ? 0.0 : full[dof]));
}

TEST_CASE("two values for one component are refused, one value twice is not", "[assembly][conditions]") {
  Scene scene;
  scene.fix("fixed").prescribe(std::vector<NodeId>{0}, {0.0, 0.0, 0.0});
  CHECK_NOTHROW(conditions_of(cubes.mesh, scene));
  scene.prescribe(std::vector<NodeId>{3}, {std::nullopt, 1e-300, std::nullopt});
  const SetupProblem p = refusal([&] { conditions_of(cubes.mesh, scene); });
  CHECK(to_string(p.kind) == "conflicting_conditions");
  CHECK_THAT(p.what, contains("component y"));
  CHECK(p.ids == std::vector<std::int64_t>{3});
  CHECK(p.ids_of == SetupIds::nodes);
}

TEST_CASE("conditions on missing groups, nodes and faces are refused", "[assembly][conditions]") {
  Scene scene;
  SECTION("unknown group") {
    scene.fix("liver");
    const SetupProblem p = refusal([&] { conditions_of(cubes.mesh, scene); });
    CHECK(to_string(p.kind) == "unknown_group");
    CHECK_THAT(p.what, contains("'liver'"));
    CHECK_THAT(p.hint, contains("fixed"));
  }
  SECTION("empty group") {
    CHECK_REFUSED(SetupErrorKind::empty_group, conditions_of(cubes.mesh, scene.fix(std::vector<NodeId>{})));
  }
  SECTION("node ids") {
    CHECK_REFUSED(SetupErrorKind::index_out_of_range, conditions_of(cubes.mesh, Scene().fix(std::vector<NodeId>{12})));
    CHECK_REFUSED(SetupErrorKind::index_out_of_range, conditions_of(cubes.mesh, Scene().fix(std::vector<NodeId>{-1})));
  }
  SECTION("a traction needs a face") {
    CHECK_REFUSED(SetupErrorKind::empty_group, load_of(Scene().traction("load_point", {1, 0, 0})));
    CHECK_REFUSED(SetupErrorKind::unknown_group, load_of(Scene().pressure("nowhere", 1.0)));
    CHECK_REFUSED(SetupErrorKind::unknown_group, load_of(Scene().point_load("nowhere", {1, 0, 0})));
  }
  SECTION("an inner face") {
    Body<Tet4> body = cubes;
    body.mesh.groups.get_or_add("inner", 2).faces = {{4, 7, 5}, {4, 6, 7}};
    CHECK_REFUSED(SetupErrorKind::unsupported, load_of(Scene().traction("inner", {1, 0, 0}), body));
  }
  SECTION("regions") {
    CHECK_REFUSED(SetupErrorKind::unknown_group, load_of(Scene().body_load("cube_c", {1, 0, 0})));
    CHECK_REFUSED(SetupErrorKind::unknown_group,
                  detail::initial_strains_by_region(cubes.mesh, Scene().initial_strain("cube_c", Vector6::Ones())));
  }
  SECTION("NaN and infinity") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_REFUSED(SetupErrorKind::non_finite, Scene().prescribe("end", {0.0, nan, 0.0}));
    CHECK_REFUSED(SetupErrorKind::non_finite, Scene().traction("end", {infinity, 0, 0}));
    CHECK_REFUSED(SetupErrorKind::non_finite, Scene().pressure("end", nan));
    CHECK_REFUSED(SetupErrorKind::non_finite, Scene().point_load("end", {infinity, -infinity, 0}));
    CHECK_REFUSED(SetupErrorKind::non_finite, Scene().gravity({0, nan, 0}));
  }
}

TEST_CASE("loads have the right sums", "[assembly][loads]") {
  SECTION("traction") {
    const VectorX f = load_of(Scene().traction("end", {10, -2, 3}));
    CHECK(largest(total(f) - Vector3(10, -2, 3)) <= 1e-13);
    CHECK(f.head(24).isZero(0.0));
  }
  SECTION("pressure pushes inwards") {
    CHECK(largest(total(load_of(Scene().pressure("end", 7.0))) - Vector3(-7, 0, 0)) <= 1e-13);
    CHECK(largest(total(load_of(Scene().pressure("fixed", 7.0))) - Vector3(7, 0, 0)) <= 1e-13);
  }
  SECTION("pressure on the whole surface has zero sum and zero moment") {
    const Body<Tet4> sphere = body_of(sphere_tet4(1.0, 2), {liver});
    const VectorX f = load_of(Scene().pressure("surface", 1.0), sphere);
    CHECK(largest(total(f)) <= 1e-14);
    CHECK(largest(total_moment(f, sphere)) <= 1e-14);
    CHECK(largest(f) > 0.01);
    CHECK(largest(total(load_of(Scene().pressure("surface", 1.0)))) <= 1e-14);  // a group the mesh does not list
  }
  SECTION("a point load is divided among the nodes") {
    const VectorX f = load_of(Scene().point_load("end", {4, 8, -12}));
    for (Index i = 8; i < 12; ++i) CHECK(f.segment<3>(3 * i) == Vector3(1, 2, -3));
  }
  SECTION("body loads by region") {
    CHECK(largest(total(load_of(Scene().body_load(everywhere, {0, 0, 3}))) - Vector3(0, 0, 6)) <= 1e-13);
    CHECK(largest(total(load_of(Scene().body_load("cube_b", {0, 0, 3}))) - Vector3(0, 0, 3)) <= 1e-13);
    CHECK(load_of(Scene().body_load("cube_b", {0, 0, 3})).head(12).isZero(0.0));
  }
  SECTION("loads are added") {
    Scene both, one, other;
    one.traction("end", {1, 2, 3}).point_load("load_point", {0, 0, 1});
    other.traction("end", {1, 2, 3});
    both.traction("end", {1, 2, 3}).traction("end", {1, 2, 3}).point_load("load_point", {0, 0, 1});
    CHECK(largest(load_of(both) - load_of(one) - load_of(other)) <= 1e-15);
  }
}

TEST_CASE("nodal masses sum to density times volume", "[assembly][mass]") {
  CHECK_THAT(nodal_mass(cubes).sum(), Catch::Matchers::WithinRel(2.0, 1e-13));
  const Body<Tet4> two = body_of(two_cubes(), {liver, reference_material});
  CHECK_THAT(nodal_mass(two).sum(), Catch::Matchers::WithinRel(1061.0, 1e-13));
  const MatrixX consistent = read_matrix(two_cubes_folder + "M_consistent_getfem.csv");
  REQUIRE(consistent.rows() == 36);
  const VectorX mass = nodal_mass(cubes), rows = consistent.rowwise().sum();
  for (Index i = 0; i < 12; ++i)
    for (int c = 0; c < 3; ++c) CHECK_THAT(rows[3 * i + c], Catch::Matchers::WithinRel(mass[i], 1e-12));
}

TEST_CASE("initial strain: sums, regions, energy", "[assembly][strain]") {
  Body<Tet4> body = cubes;
  CHECK(detail::initial_strain_load(body).isZero(0.0));
  Vector6 strain;
  strain << 1e-3, -2e-3, 5e-4, 1e-4, 2e-4, -3e-4;
  body.initial_strain = detail::initial_strains_by_region(
      body.mesh, Scene().initial_strain("cube_b", strain).initial_strain(everywhere, strain));
  CHECK(body.initial_strain[0] == strain);
  CHECK(body.initial_strain[1] == 2.0 * strain);
  const VectorX f = detail::initial_strain_load(body);
  CHECK(largest(total(f)) <= 1e-15);
  CHECK(largest(total_moment(f)) <= 1e-15);
  const Matrix6 d = reference_material.elasticity();
  const double stored = 0.5 * strain.dot(d * strain);
  CHECK_THAT(strain_energy(body, VectorX::Zero(36)), Catch::Matchers::WithinRel(5.0 * stored, 1e-12));
}

TEST_CASE("one material per region", "[assembly][material]") {
  const Mesh<Tet4> mesh = two_cubes();
  using Materials = RegionMaterials<LinearElastic>;
  const auto young = [&](const Materials& m) {
    const auto all = detail::materials_by_region(mesh, m);
    return std::array{all.at(0).youngs_modulus, all.at(1).youngs_modulus};
  };
  const LinearElastic soft{1.0, 0.3, 0.0}, hard{2.0, 0.3, 0.0};
  CHECK(young({{everywhere, soft}}) == std::array{1.0, 1.0});
  CHECK(young({{"cube_b", hard}, {everywhere, soft}}) == std::array{1.0, 2.0});
  CHECK(young({{everywhere, soft}, {"cube_a", hard}}) == std::array{2.0, 1.0});
  CHECK_REFUSED(SetupErrorKind::missing_material, young({{"cube_a", soft}}));
  CHECK_REFUSED(SetupErrorKind::missing_material, young({}));
  CHECK_REFUSED(SetupErrorKind::unknown_group, young({{everywhere, soft}, {"cube_c", hard}}));
  const SetupProblem p = refusal([&] { young({{everywhere, soft}, {"cube_b", {1.0, 0.5, 0.0}}}); });
  CHECK(to_string(p.kind) == "bad_poisson_ratio");
  CHECK(p.ids == std::vector<std::int64_t>{1});
  CHECK_THAT(p.what, contains("cube_b"));
}
