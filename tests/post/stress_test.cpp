// Stress against closed forms, and against another code.
#include <palpate/element/tet4.hpp>
#include <palpate/io/detail/text_reader.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/post/stress.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

#include <map>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr LinearElastic gel{.youngs_modulus = 5e3, .poisson_ratio = 0.3};

Body<Tet4> body_of(Mesh<Tet4> mesh, const LinearElastic& material = gel, const Vector6& strain0 = Vector6::Zero()) {
  const auto regions = static_cast<std::size_t>(mesh.region_count());
  return {std::move(mesh), std::vector<Matrix6>(regions, material.elasticity()), std::vector<double>(regions, 0.0),
          std::vector<Vector6>(regions, strain0)};
}

/// u = H x: the same strain everywhere.
VectorX linear_field(const Mesh<Tet4>& mesh, const Matrix3& gradient) {
  VectorX u(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = gradient * mesh.position(i);
  return u;
}

/// Largest difference of any column to `expected`, element means and nodal values.
double difference(const StressField& field, const Vector6& expected) {
  return std::max((field.elements.colwise() - expected).cwiseAbs().maxCoeff(),
                  (field.nodes.colwise() - expected).cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("A bar under tension has the uniaxial stress E times strain", "[post]") {
  const double strain = GENERATE(1e-3, -0.2, 1e-12);
  const double nu = GENERATE(0.0, 0.3, 0.45, -0.5);
  const LinearElastic material{.youngs_modulus = 5e3, .poisson_ratio = nu};
  const Body<Tet4> bar = body_of(box_tet4({0.1, 0.02, 0.02}, {5, 2, 2}), material);
  const Matrix3 gradient = Vector3(strain, -nu * strain, -nu * strain).asDiagonal();
  const StressField field = stress_field(bar, linear_field(bar.mesh, gradient));

  const double stress = 5e3 * strain;
  CHECK(difference(field, (Vector6() << stress, 0, 0, 0, 0, 0).finished()) <= 1e-12 * std::abs(stress));
  for (const VectorX& equivalent : {field.von_mises_elements, field.von_mises_nodes})
    CHECK((equivalent.array() - std::abs(stress)).abs().maxCoeff() <= 1e-12 * std::abs(stress));
  CHECK_THAT(field.node_volumes.sum(), WithinRel(4.0 * 0.1 * 0.02 * 0.02, 1e-12));
}

TEST_CASE("Von Mises of pure shear, of pressure and of a plane state", "[post]") {
  const Body<Tet4> cube = body_of(box_tet4({1, 1, 1}, {2, 2, 2}));
  Matrix3 shear = Matrix3::Zero();
  shear(0, 2) = 0.01;  // gamma_xz
  const StressField sheared = stress_field(cube, linear_field(cube.mesh, shear));
  const double tau = gel.shear_modulus() * 0.01;
  CHECK(difference(sheared, (Vector6() << 0, 0, 0, 0, tau, 0).finished()) <= 1e-12 * tau);
  CHECK_THAT(sheared.von_mises_nodes.maxCoeff(), WithinRel(std::sqrt(3.0) * tau, 1e-12));

  const StressField pressed = stress_field(cube, linear_field(cube.mesh, -0.01 * Matrix3::Identity()));
  const double pressure = -5e3 * 0.01 / (1.0 - 2.0 * 0.3);
  CHECK(difference(pressed, (Vector6() << pressure, pressure, pressure, 0, 0, 0).finished()) <= 1e-11 * -pressure);
  CHECK(pressed.von_mises_nodes.maxCoeff() <= 1e-11 * -pressure);

  const StressColumns plane = (StressColumns(6, 2) << 3, 1, 1, 1, 0, 1, 2, 0, 0, 0, 0, 0).finished();
  VectorX equivalent;
  von_mises(plane, equivalent);  // sqrt(sx^2 - sx sy + sy^2 + 3 txy^2), and zero for a pressure
  CHECK_THAT(equivalent[0], WithinRel(std::sqrt(9.0 - 3.0 + 1.0 + 12.0), 1e-14));
  CHECK_THAT(equivalent[1], WithinAbs(0.0, 1e-14));
}

TEST_CASE("A rigid motion and free swelling cause no stress", "[post]") {
  testing::Random random(7);
  const Vector6 swelling = random.vector<6>(-0.1, 0.1);
  const Body<Tet4> cube = body_of(box_tet4({1, 1, 1}, {2, 2, 2}), gel, swelling);
  Matrix3 gradient;  // the strain of the swelling, and a rotation
  gradient << swelling[0], swelling[3], swelling[4], 0, swelling[1], swelling[5], 0, 0, swelling[2];
  const Vector3 turn = random.vector<3>(-0.1, 0.1);
  for (int i = 0; i < 3; ++i) gradient.col(i) += turn.cross(Vector3::Unit(i));
  VectorX u = linear_field(cube.mesh, gradient);
  for (Index i = 0; i < cube.mesh.node_count(); ++i) u.segment<3>(3 * i) += Vector3(3.0, -2.0, 1.0);
  CHECK(difference(stress_field(cube, u), Vector6::Zero()) <= 1e-13 * 5e3);
  CHECK(difference(stress_field(cube, VectorX::Zero(u.size())), -(gel.elasticity() * swelling)) <= 1e-13 * 5e3);
}

TEST_CASE("Nodal stress is the volume-weighted mean of the elements", "[post]") {
  Mesh<Tet4> pair;
  pair.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -3}, {5, 5, 5}};  // the last has no element
  pair.elements = {{0, 1, 2, 3}, {0, 2, 1, 4}};                                          // volumes 1/6 and 3/6
  const Body<Tet4> body = body_of(pair);
  VectorX u = VectorX::Zero(18);
  u[11] = 0.01;  // node 3 moves by 0.01 along z: strain in the first element only
  const StressField field = stress_field(body, u);
  const Vector6 first = gel.elasticity() * Vector6::Unit(voigt::zz) * 0.01;
  CHECK((field.elements.col(0) - first).norm() <= 1e-13 * first.norm());
  CHECK(field.elements.col(1).isZero(0.0));
  for (int i : {0, 1, 2}) CHECK((field.nodes.col(i) - 0.25 * first).norm() <= 1e-13 * first.norm());
  CHECK((field.nodes.col(3) - first).norm() <= 1e-13 * first.norm());
  CHECK(field.nodes.col(5).isZero(0.0));
  CHECK_THAT(field.von_mises_nodes[0], WithinRel(0.25 * voigt::von_mises(first), 1e-13));
}

TEST_CASE("Mean and point stress of an element agree where the stress is constant", "[post]") {
  testing::Random random(11);
  const ElementNodes<Tet4> x = Tet4::reference_nodes() + 0.2 * random.vector<12>(-1.0, 1.0).reshaped(4, 3);
  const ElementNodes<Tet4> u = random.vector<12>(-0.1, 0.1).reshaped(4, 3);
  const Vector6 strain0 = random.vector<6>(-0.1, 0.1);
  const detail::MeanStress mean = detail::mean_stress<Tet4>(x, u, gel.elasticity(), strain0);
  const Vector6 point = point_stress<Tet4>(x, u, {0.1, 0.2, 0.3}, gel.elasticity(), strain0);
  CHECK((mean.stress - point).norm() <= 1e-12 * point.norm());
}

TEST_CASE("Stress stays accurate far from the origin", "[post]") {
  Mesh<Tet4> cube = box_tet4({0.1, 0.1, 0.1}, {2, 2, 2});
  Matrix3 gradient = Vector3(0.01, 0.0, 0.0).asDiagonal();
  const VectorX u = linear_field(cube, gradient);
  for (Vector3& x : cube.positions) x += Vector3::Constant(1e4);
  const Vector6 expected = gel.elasticity() * Vector6::Unit(voigt::xx) * 0.01;
  CHECK(difference(stress_field(body_of(cube), u), expected) <= 1e-9 * expected.norm());
}

TEST_CASE("A displacement that is not finite gives stress that is not finite; a wrong length is refused", "[post]") {
  const Body<Tet4> cube = body_of(box_tet4({1, 1, 1}, {2, 2, 2}));
  VectorX u = VectorX::Zero(3 * cube.mesh.node_count());
  u[0] = std::numeric_limits<double>::quiet_NaN();
  const StressField field = stress_field(cube, u);
  CHECK(std::isnan(field.von_mises_nodes[0]));
  CHECK(field.von_mises_nodes[cube.mesh.node_count() - 1] == 0.0);
  CHECK_THROWS_AS(stress_field(cube, VectorX::Zero(u.size() - 1)), SetupError);
  CHECK_THROWS_AS(stress_field(cube, VectorX()), SetupError);
}

TEST_CASE("Element stresses agree with another code", "[post][oracle]") {
  const std::string folder = PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/";
  io::MeshNumbering ids;
  const auto mesh = io::read_mesh<Tet4>(folder + "mesh_v22.msh", 1.0, &ids);
  Scene scene;
  scene.fix("fixed");
  std::string name;
  SECTION("own weight") {
    name = "gravity";
    scene.gravity({0.0, 0.0, -9.81});
  }
  SECTION("a force on a corner") {
    name = "point_z";
    scene.point_load("load_point", {0.0, 0.0, -1.0});
  }
  SECTION("an orthotropic initial strain") {
    name = "initial_strain_ortho";
    scene.initial_strain(everywhere, (Vector6() << 0.001, -0.002, 0.0005, 0, 0, 0).finished());
  }
  HapticFEModel<Tet4, LinearElastic, SparseCholesky> model(mesh, scene, LinearElastic{1000.0, 0.3, 1.0});
  const StressField field = stress_field(model.body(), model.displacement());

  std::map<Index, Index> element_of;
  for (std::size_t e = 0; e < ids.element_tags.size(); ++e) element_of[ids.element_tags[e]] = static_cast<Index>(e);
  std::string text = io::read_file(folder + name + "_stress.csv");
  std::ranges::replace(text, ',', ' ');
  io::TextReader in(text, name);
  in.need_line("a header");
  double largest = 0.0, worst = 0.0;
  int lines = 0;
  for (; in.next_line(); ++lines) {
    const Index e = element_of.at(in.integer("an element id", 1, 1000));
    in.token();
    for (int c = 0; c < 6; ++c) {
      const double reference = in.real("a stress");
      largest = std::max(largest, std::abs(reference));
      worst = std::max(worst, std::abs(reference - field.elements(c, e)));
    }
  }
  CHECK(lines == 10);
  CHECK(worst <= 1e-6 * largest);
}
