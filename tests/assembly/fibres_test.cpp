// Bodies with one fibre direction per element.
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/refine.hpp>
#include <palpate/post/stress.hpp>
#include <palpate/testing/assembler_laws.hpp>

#include "assembly/bodies.hpp"
#include "mesh/two_cubes.hpp"

using namespace test;

namespace {

const TransverselyIsotropic muscle{60e3, 12e3, 0.45, 0.6, 9e3, Vector3::UnitX(), 1060.0};

Vector3 random_direction(testing::Random& random) {
  return testing::random_rotation(random).col(0);
}

template <Element E>
void give_fibres(Mesh<E>& mesh) {
  testing::Random random(101);
  mesh.fibres.clear();
  for (Index e = 0; e < mesh.element_count(); ++e) mesh.fibres.push_back(random_direction(random));
}

/// The same body without fibres in the mesh: every element is a region with its own rotated material.
template <Element E>
Body<E> by_regions(Mesh<E> mesh) {
  std::vector<TransverselyIsotropic> materials;
  mesh.region_names.clear();
  mesh.regions.clear();
  for (Index e = 0; e < mesh.element_count(); ++e) {
    materials.push_back(muscle);
    materials.back().fibre = mesh.fibre(e);
    mesh.regions.push_back(static_cast<int>(e));
    mesh.region_names.push_back("element " + std::to_string(e));
  }
  mesh.fibres.clear();
  return make_body(std::move(mesh), materials);
}

VectorX waves(Index size) {
  VectorX u(size);
  for (Index i = 0; i < size; ++i) u[i] = 1e-3 * std::sin(static_cast<double>(3 * i));
  return u;
}

template <Element E>
VectorX forces(const Body<E>& body, const VectorX& u) {
  VectorX f(u.size());
  assemble_stiffness<E>(body, {}).apply(u, f);
  return f;
}

std::vector<std::int64_t> bad_elements(const Mesh<Tet4>& mesh) {
  const SetupProblem p = refusal([&] { admit<Tet4>(mesh); });
  CHECK(p.kind == SetupErrorKind::bad_argument);
  return p.ids;
}

}  // namespace

TEMPLATE_TEST_CASE("a fibre direction per element equals a rotated material per region", "[assembly][fibres]", Tet4,
                   Tet10, Hex8, MeanDilatation<Hex8>) {
  using E = TestType;
  Mesh<E> mesh;
  const auto take = [&](auto box) {
    mesh.positions = std::move(box.positions);
    mesh.elements = std::move(box.elements);
  };
  if constexpr (E::nodes == 4) take(box_tet4({0.3, 0.2, 0.1}, {2, 2, 1}));
  if constexpr (E::nodes == 8) take(box_hex8({0.3, 0.2, 0.1}, {2, 2, 1}));
  if constexpr (E::nodes == 10) take(box_tet10({0.3, 0.2, 0.1}, {2, 1, 1}));
  give_fibres(mesh);
  Body<E> body = make_body(mesh, muscle), same = by_regions(mesh);
  const VectorX u = waves(3 * mesh.node_count()), f = forces(body, u);
  const double scale = f.cwiseAbs().maxCoeff();
  CHECK((f - forces(same, u)).cwiseAbs().maxCoeff() == 0.0);
  VectorX free(u.size());
  detail::MatrixFreeStiffness<E>(body, {}).apply(u, free);
  CHECK((free - f).cwiseAbs().maxCoeff() <= 1e-12 * scale);
  CHECK(strain_energy(body, u) == strain_energy(same, u));
  CHECK_THAT(strain_energy(body, u), Catch::Matchers::WithinRel(0.5 * u.dot(f), 1e-12));
  CHECK((stress_field(body, u).elements - stress_field(same, u).elements).cwiseAbs().maxCoeff() == 0.0);
  const Vector6 strain = 0.01 * Vector6::Ones();
  body.initial_strain.assign(body.initial_strain.size(), strain);
  same.initial_strain.assign(same.initial_strain.size(), strain);
  CHECK((detail::initial_strain_load(body) - detail::initial_strain_load(same)).cwiseAbs().maxCoeff() == 0.0);

  Mesh<E> along_x = mesh;  // the direction matters
  along_x.fibres.assign(along_x.fibres.size(), Vector3::UnitX());
  CHECK((forces(make_body(along_x, muscle), u) - f).norm() > 0.05 * f.norm());
  CHECK(make_body(along_x, muscle).elasticity.size() == 1);  // equal neighbours share one matrix
  along_x.fibres.clear();
  CHECK(forces(make_body(along_x, muscle), u) == forces(make_body(along_x, muscle), u));
  CHECK(make_body(along_x, muscle).materials.empty());
}

TEST_CASE("a body with fibres passes the stiffness law suite", "[assembly][fibres][laws]") {
  Mesh<Tet4> mesh = box_tet4({0.3, 0.2, 0.1}, {2, 2, 1});
  give_fibres(mesh);
  const Body<Tet4> body = make_body(mesh, muscle);
  CHECK(testing::describe(testing::stiffness_laws(body, assemble_stiffness<Tet4>(body, {}))) == "");
}

TEST_CASE("rotating body and fibres rotates the forces", "[assembly][fibres][metamorphic]") {
  testing::Random random(103);
  Mesh<Tet4> mesh = jittered(box_tet4({3, 2, 1}, {3, 2, 1}), 0.1, {3, 2, 1});
  give_fibres(mesh);
  const VectorX u = waves(3 * mesh.node_count()), f = forces(make_body(mesh, muscle), u);
  for (int k = 0; k < 5; ++k) {
    const Matrix3 r = testing::random_rotation(random);
    const auto turn = [&](const VectorX& v) {
      VectorX w = v;
      for (Index i = 0; i < v.size(); i += 3) w.segment<3>(i) = r * v.segment<3>(i);
      return w;
    };
    Mesh<Tet4> rotated = mesh;
    for (Vector3& x : rotated.positions) x = (r * x).eval();
    const VectorX forgotten = forces(make_body(rotated, muscle), turn(u));
    for (Vector3& fibre : rotated.fibres) fibre = (r * fibre).eval();
    CHECK((forces(make_body(rotated, muscle), turn(u)) - turn(f)).norm() <= 1e-12 * f.norm());
    CHECK((forgotten - turn(f)).norm() > 1e-2 * f.norm());
  }
}

TEST_CASE("isotropic materials ignore fibres", "[assembly][fibres]") {
  Mesh<Tet4> mesh = two_cubes();
  const auto plain = make_body(mesh, liver);
  give_fibres(mesh);
  const TransverselyIsotropic iso{5e3, 5e3, 0.45, 0.45, liver.shear_modulus(), Vector3::UnitX(), 1060.0};
  const VectorX u = waves(3 * mesh.node_count()), f = forces(plain, u);
  CHECK((forces(make_body(mesh, iso), u) - f).norm() <= 1e-12 * f.norm());
  CHECK(forces(make_body(mesh, liver), u) == f);  // a material that does not use fibres
  CHECK(make_body(mesh, liver).materials.empty());
}

TEST_CASE("materials differ between regions and fibres between elements", "[assembly][fibres]") {
  Mesh<Tet4> mesh = two_cubes();
  give_fibres(mesh);
  TransverselyIsotropic soft = muscle;
  soft.youngs_modulus_along = 30e3;
  const Body<Tet4> body = make_body(mesh, std::vector{muscle, soft});
  for (Index e = 0; e < mesh.element_count(); ++e)
    CHECK(body.elasticity_of(e) == (mesh.region(e) == 0 ? muscle : soft).elasticity(mesh.fibre(e)));
}

TEST_CASE("admission, promotion and refinement keep the fibres", "[mesh][fibres]") {
  Mesh<Tet4> mesh = box_tet4({3, 2, 1}, {2, 1, 1});
  give_fibres(mesh);
  CHECK(admit<Tet4>(mesh).mesh.fibres == mesh.fibres);
  CHECK(promote<Tet10>(mesh).fibres == mesh.fibres);
  const Mesh<Tet4> fine = refine(mesh);
  REQUIRE(fine.fibres.size() == 8 * mesh.fibres.size());
  for (std::size_t e = 0; e < fine.fibres.size(); ++e) CHECK(fine.fibres[e] == mesh.fibres[e / 8]);

  Mesh<Tet4> damaged = mesh;  // a duplicate element, a flat one, an inverted one
  damaged.elements.insert(damaged.elements.begin() + 3, damaged.elements[1]);
  damaged.fibres.insert(damaged.fibres.begin() + 3, Vector3::UnitZ());
  damaged.elements.insert(damaged.elements.begin() + 5, {0, 1, 2, 2});
  damaged.elements[5] = {damaged.elements[0][0], damaged.elements[0][1], damaged.elements[0][2],
                         damaged.elements[0][0]};
  damaged.fibres.insert(damaged.fibres.begin() + 5, Vector3::UnitY());
  std::swap(damaged.elements[7][0], damaged.elements[7][1]);
  AdmissionPolicy mend;
  mend.duplicate_elements = mend.degenerate = mend.inverted = Admission::repair;
  CHECK(admit<Tet4>(damaged, mend).mesh.fibres == mesh.fibres);
}

TEST_CASE("fibres in user-defined arrays", "[mesh][fibres]") {
  Mesh<Tet4> mesh = two_cubes();
  give_fibres(mesh);
  std::vector<double> positions, fibres;
  std::vector<int> connectivity;
  for (const Vector3& x : mesh.positions) positions.insert(positions.end(), {x[0], x[1], x[2]});
  for (const Vector3& f : mesh.fibres) fibres.insert(fibres.end(), {f[0], f[1], f[2]});
  for (const auto& nodes : mesh.elements) connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
  MeshArrays<Tet4, double, int> arrays(positions, connectivity);
  STATIC_REQUIRE(FibreMesh<decltype(arrays)>);
  CHECK(admit<Tet4>(arrays).mesh.fibres.empty());
  arrays.fibres(fibres);
  CHECK(admit<Tet4>(arrays).mesh.fibres == mesh.fibres);
  fibres.pop_back();
  CHECK_REFUSED(SetupErrorKind::bad_argument, arrays.fibres(fibres));
}

TEST_CASE("invalid fibre directions are refused by element", "[mesh][fibres][extreme]") {
  Mesh<Tet4> mesh = two_cubes();
  give_fibres(mesh);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3& bad : {Vector3(0, 0, 0), Vector3(nan, 0, 0), Vector3(2, 0, 0), Vector3(infinity, 0, 0),
                             Vector3(1.0 + 2e-5, 0, 0), Vector3(1, 1, 0)}) {
    Mesh<Tet4> spoilt = mesh;
    spoilt.fibres[3] = spoilt.fibres[7] = bad;
    CHECK(bad_elements(spoilt) == std::vector<std::int64_t>{3, 7});
    CHECK_REFUSED(SetupErrorKind::bad_argument, make_body(spoilt, muscle));
  }
  Mesh<Tet4> printed = mesh;  // six digits in a file
  for (Vector3& f : printed.fibres) f = (f.array() * 1e6).round() / 1e6;
  CHECK(admit<Tet4>(printed).mesh.fibres == printed.fibres);
  const Matrix6 d = muscle.elasticity(printed.fibres[0]), exact = muscle.elasticity(mesh.fibres[0]);
  CHECK((d - exact).norm() <= 1e-5 * exact.norm());
  mesh.fibres.pop_back();
  CHECK_REFUSED(SetupErrorKind::bad_argument, admit<Tet4>(mesh));
  CHECK_REFUSED(SetupErrorKind::bad_argument, make_body(mesh, muscle));
}
