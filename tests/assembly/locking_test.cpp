// Volumetric locking of plain elements, and elements that avoid it.
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/testing/assembler_laws.hpp>

#include <Eigen/SparseCholesky>

#include "assembly/bodies.hpp"
#include "local/closed_form.hpp"

using namespace test;

namespace {

/// The same arrays as a mesh of another element type.
template <Element To, Element From>
Mesh<To> as(const Mesh<From>& mesh) {
  return {mesh.positions, mesh.elements, mesh.regions, mesh.region_names, mesh.groups};
}

/// Tip deflection of a beam 4 x 1 x 1 m, clamped at x = 0, E = 1 Pa, with a shear force of 1e-3 N distributed over its
/// end.
template <Element E>
double tip_deflection(const Mesh<E>& mesh, double nu) {
  const Scene scene = Scene().fix("x0").traction("x1", {0.0, 0.0, -1e-3});
  const Body<E> body = body_of(mesh, {{1.0, nu, 1.0}});
  const auto boundary = extract_boundary<E>(mesh);
  const EssentialConditions conditions = resolve_essential(mesh, boundary, scene);
  const VectorX load = detail::applied_load(body, boundary, scene);
  VectorX free(conditions.free_count());
  conditions.gather(load, free);
  const BlockMatrix k = assemble_stiffness<E>(body, {});
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower> solver(free_matrix(k, conditions));
  REQUIRE(solver.info() == Eigen::Success);
  return free.dot(solver.solve(free)) / 1e-3;  // mean over the end, weighted like the load
}

using Cured = MeanDilatation<Hex8>;

}  // namespace

TEST_CASE("MeanDilatation passes the stiffness law suite", "[assembly][locking]") {
  Mesh<Cured> mesh = as<Cured>(box_hex8({1, 2, 3}, {2, 2, 1}));
  testing::Random random(67);
  for (Vector3& x : mesh.positions) x += random.vector<3>(-0.1, 0.1);
  for (bool isotropic : {true, false}) {
    Body<Cured> body = body_of(mesh, {liver});
    if (!isotropic) body.elasticity.front() = orthotropic();
    const BlockMatrix stored = assemble_stiffness<Cured>(body, {});
    const detail::MatrixFreeStiffness<Cured> free(body, {});
    CHECK(testing::describe(testing::stiffness_laws(body, stored, 1)) == "");
    CHECK(testing::describe(testing::same_stiffness_laws(stored, free)) == "");
  }
}

TEST_CASE("MeanDilatation: one volume change per element, and the energy equals that of K", "[assembly][locking]") {
  testing::Random random(71);
  ElementNodes<Cured> x = Hex8::reference_nodes(), u;
  for (int a = 0; a < 8; ++a) {
    x.row(a) += random.vector<3>(-0.2, 0.2).transpose();
    u.row(a) = random.vector<3>(-0.1, 0.1).transpose();
  }
  const auto points = detail::integration_points<Cured>(x);
  const auto plain = detail::integration_points<Hex8>(x);
  double changed = 0.0, volume = 0.0, energy = 0.0;
  ElementNodes<Cured> force = ElementNodes<Cured>::Zero();
  const Matrix6 d = orthotropic();
  for (std::size_t q = 0; q < points.size(); ++q) {
    const Vector6 e = detail::strain_at<Cured>(points[q], u);
    CHECK_THAT(e.head<3>().sum(),
               Catch::Matchers::WithinAbs(detail::strain_at<Cured>(points[0], u).head<3>().sum(), 1e-15));
    CHECK(largest(e.tail<3>() - detail::strain_at<Hex8>(plain[q], u).tail<3>()) == 0.0);
    changed += plain[q].volume * detail::strain_at<Hex8>(plain[q], u).head<3>().sum();
    volume += points[q].volume;
    energy += 0.5 * points[q].volume * e.dot(d * e);
    force += detail::force_of_stress<Cured>(points[q], d * e);
  }
  CHECK_THAT(detail::strain_at<Cured>(points[0], u).head<3>().sum(),
             Catch::Matchers::WithinRel(changed / volume, 1e-12));
  CHECK_THAT(0.5 * force.cwiseProduct(u).sum(), Catch::Matchers::WithinRel(energy, 1e-12));
  Eigen::Matrix<double, 24, 1> v, f;
  for (int a = 0; a < 8; ++a) {
    v.segment<3>(3 * a) = u.row(a).transpose();
    f.segment<3>(3 * a) = force.row(a).transpose();
  }
  CHECK(largest(detail::element_stiffness<Cured>(x, d) * v - f) <= 1e-13 * largest(f));
}

TEST_CASE("near incompressibility Hex8 locks, MeanDilatation<Hex8> and quadratic elements do not",
          "[assembly][locking]") {
  // Converged values 0.2636, 0.2584 and 0.2559: Taylor-Hood elements on fine meshes, to 0.3 %.
  const Mesh<Hex8> coarse = box_hex8({4, 1, 1}, {16, 4, 4});
  const auto error = [](double deflection, double exact) { return deflection / exact - 1.0; };
  for (const auto& [nu, exact] : {std::pair{0.3, 0.2636}, std::pair{0.45, 0.2584}, std::pair{0.499, 0.2559}}) {
    const double plain = error(tip_deflection(coarse, nu), exact);
    const double cured = error(tip_deflection(as<Cured>(coarse), nu), exact);
    const double tet10 = error(tip_deflection(box_tet10({4, 1, 1}, {8, 2, 2}), nu), exact);
    const double hex20 = error(tip_deflection(box_hex20({4, 1, 1}, {8, 2, 2}), nu), exact);
    INFO("nu " << nu << ": Hex8 " << plain << ", cured " << cured << ", Tet10 " << tet10 << ", Hex20 " << hex20);
    CHECK(std::abs(cured) < 0.025);
    CHECK(std::abs(hex20) < 0.08);
    CHECK(std::abs(tet10) < 0.08);
    if (nu == 0.3) CHECK(std::abs(plain) < 0.06);
    if (nu == 0.499) CHECK(plain < -0.3);
  }
}

TEST_CASE("near incompressibility Tet4 locks, Smoothed<Tet4> does not", "[assembly][locking][A2]") {
  const BoxSplit split = GENERATE(BoxSplit::five_mirrored, BoxSplit::six);
  const Mesh<Tet4> mesh = box_tet4({4, 1, 1}, {16, 4, 4}, split);
  double before = infinity;
  for (const auto& [nu, exact] :
       {std::pair{0.3, 0.2636}, {0.45, 0.2584}, {0.49, 0.2564}, {0.499, 0.2559}, {0.4999, 0.2558}}) {
    const double plain = tip_deflection(mesh, nu) / exact - 1.0;
    const double cured = tip_deflection(as<Smoothed<Tet4>>(mesh), nu) / exact - 1.0;
    INFO("nu " << nu << ": Tet4 " << plain << ", Smoothed<Tet4> " << cured);
    CHECK(std::abs(cured) < 0.12);
    CHECK(std::abs(cured) < 0.4 * std::abs(plain));
    CHECK(cured < before);  // stiffer with nu, at a decreasing rate
    before = cured;
  }
}
