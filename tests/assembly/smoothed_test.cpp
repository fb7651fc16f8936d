// Tetrahedra with strain averaged over neighbours.
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/testing/assembler_laws.hpp>

#include "assembly/bodies.hpp"
#include "local/closed_form.hpp"

using namespace test;

namespace {

using Averaged = Smoothed<Tet4>;

/// A box of 3 x 2 x 2 distorted cells in two regions with a plane border.
Mesh<Averaged> box() {
  const Vector3 size(3, 2, 2);
  const Mesh<Tet4> plain = box_tet4(size, {4, 2, 2}, BoxSplit::six);
  Mesh<Averaged> mesh{plain.positions, plain.elements, {}, {"left", "right"}, plain.groups};
  testing::Random random(5);
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.regions.push_back(element_nodes<Averaged>(mesh, e).col(0).mean() < 1.5 ? 0 : 1);
  for (Vector3& x : mesh.positions) {
    const Vector3 step = random.vector<3>(-0.12, 0.12);
    const bool inside = (x.array() > 1e-9).all() && (x.array() < size.array() - 1e-9).all();
    if (inside && std::abs(x[0] - 1.5) > 1e-9) x += step;
  }
  return mesh;
}

/// Two materials that alternate between elements, as along fibres.
void mix_materials(Body<Averaged>& body) {
  testing::Random random(17);
  body.elasticity = {orthotropic(), 3.0 * orthotropic(), liver.elasticity()};
  for (Index e = 0; e < body.mesh.element_count(); ++e)
    body.materials.push_back(static_cast<std::int32_t>(random.uniform(0.0, 2.999)));
}

VectorX random_displacement(const Mesh<Averaged>& mesh) {
  testing::Random random(11);
  return testing::random_vector(random, 3 * mesh.node_count());
}

}  // namespace

TEST_CASE("Smoothed<Tet4> passes the stiffness law suite, stored and matrix-free", "[assembly][smoothed]") {
  const int materials = GENERATE(1, 2, 3, 4);
  Body<Averaged> body = body_of(box(), {liver, materials == 2 ? LinearElastic{2e5, 0.2, 900.0} : liver});
  if (materials == 3) body.elasticity = {orthotropic(), 3.0 * orthotropic()};
  if (materials == 4) mix_materials(body);
  const BlockMatrix stored = assemble_stiffness<Averaged>(body, {});
  const detail::MatrixFreeStiffness<Averaged> free(body, {});
  CHECK(testing::describe(testing::stiffness_laws(body, stored)) == "");
  CHECK(testing::describe(testing::same_stiffness_laws(stored, free)) == "");
}

TEST_CASE("Smoothed<Tet4>: domains fill the body, and their gradients sum to zero", "[assembly][smoothed]") {
  const Mesh<Averaged> mesh = box();
  const detail::StrainDomains<Averaged> domains(mesh);
  double deviatoric = 0.0, volumetric = 0.0;
  for (Index d = 0; d < domains.size(); ++d) {
    const detail::StrainDomain domain = domains[d];
    (domain.part == detail::StrainPart::deviatoric ? deviatoric : volumetric) += domain.volume;
    Vector3 sum = Vector3::Zero();
    Matrix3 moment = Matrix3::Zero();
    for (std::size_t a = 0; a < domain.nodes.size(); ++a) {
      sum += domain.gradients[a];
      moment += mesh.position(domain.nodes[a]) * domain.gradients[a].transpose();
    }
    CHECK(largest(sum) <= 1e-13);
    CHECK(largest(moment - Matrix3::Identity()) <= 1e-13);
    for (const NodeId e : domain.elements) CHECK(mesh.region(e) == domain.region);
  }
  CHECK_THAT(deviatoric, Catch::Matchers::WithinRel(12.0, 1e-13));
  CHECK_THAT(volumetric, Catch::Matchers::WithinRel(12.0, 1e-13));
}

TEST_CASE("Smoothed<Tet4>: energy, forces and stress are consistent", "[assembly][smoothed]") {
  Body<Averaged> body = body_of(box(), {liver, {2e5, 0.2, 900.0}});
  const int materials = GENERATE(1, 2, 3);
  if (materials == 2) body.elasticity = {orthotropic(), 3.0 * orthotropic()};
  if (materials == 3) mix_materials(body);
  body.initial_strain[0] << 0.01, -0.02, 0.03, 0.04, 0.05, -0.06;
  const VectorX u = 0.1 * random_displacement(body.mesh);
  VectorX force(u.size());
  assemble_stiffness<Averaged>(body, {}).apply(u, force);
  const VectorX load = detail::initial_strain_load(body);

  // 1/2 u K u - u f_0 + 1/2 eps_0 D eps_0 V
  double at_rest = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const Vector6& e0 = body.initial_strain[body.region_of(e)];
    at_rest += 0.5 * e0.dot(body.elasticity_of(e) * e0) *
               detail::shape_volumes<Averaged>(element_nodes<Averaged>(body.mesh, e)).sum();
  }
  CHECK_THAT(strain_energy(body, u), Catch::Matchers::WithinRel(0.5 * u.dot(force) - u.dot(load) + at_rest, 1e-12));

  // the stress of every element gives the same forces as K
  const auto stress = detail::smoothed_state(body, u).stress;
  VectorX made = VectorX::Zero(u.size());
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto point = detail::integration_points<Tet4>(element_nodes<Tet4>(body.mesh, e))[0];
    const auto f = detail::force_of_stress<Tet4>(point, stress.col(e));
    for (int a = 0; a < 4; ++a) made.segment<3>(3 * Index{body.mesh.element_node(e, a)}) += f.row(a).transpose();
  }
  CHECK(largest(made - (force - load)) <= 1e-13 * largest(force));
}

TEST_CASE("Smoothed<Tet4>: a uniform initial strain is cancelled by its displacement", "[assembly][smoothed]") {
  Body<Averaged> body = body_of(box(), {liver, {2e5, 0.2, 900.0}});
  Vector6 strain;
  strain << 0.01, -0.02, 0.03, 0.04, 0.05, -0.06;
  for (Vector6& s : body.initial_strain) s = strain;
  Matrix3 gradient;
  gradient << 0.01, 0.04, 0.0, 0.0, -0.02, -0.06, 0.05, 0.0, 0.03;
  const VectorX u = testing::affine_displacement(body.mesh, Vector3(1, 2, 3), gradient);
  VectorX force(u.size());
  assemble_stiffness<Averaged>(body, {}).apply(u, force);
  const VectorX load = detail::initial_strain_load(body);
  CHECK(largest(force - load) <= 1e-12 * largest(load));
  CHECK(strain_energy(body, u) <= 1e-24 * 2e5);
  CHECK(largest(detail::smoothed_state(body, u).stress) <= 1e-13 * 2e5);
}

TEST_CASE("Smoothed<Tet4>: averages stop at the border of a material", "[assembly][smoothed]") {
  // Two blocks in series pulled along x: the strain jumps at the border, and both parts are exact.
  const Body<Averaged> body = body_of(box(), {{1e4, 0.0, 1.0}, {3e4, 0.0, 1.0}});
  VectorX u = VectorX::Zero(3 * body.mesh.node_count());
  for (Index i = 0; i < body.mesh.node_count(); ++i) {
    const double x = body.mesh.position(i)[0];
    u[3 * i] = x < 1.5 ? 0.03 * x : 0.045 + 0.01 * (x - 1.5);
  }
  VectorX force(u.size());
  assemble_stiffness<Averaged>(body, {}).apply(u, force);
  for (Index i = 0; i < body.mesh.node_count(); ++i) {
    const double x = body.mesh.position(i)[0];
    if (x > 1e-9 && x < 3.0 - 1e-9) CHECK(force.segment<3>(3 * i).norm() <= 1e-12 * 300.0);
  }
  const auto stress = detail::smoothed_state(body, u).stress;
  for (Index e = 0; e < stress.cols(); ++e) CHECK(std::abs(stress(0, e) - 300.0) <= 1e-10);
}

TEST_CASE("Smoothed<Tet4> refuses what Tet4 refuses", "[assembly][smoothed][extreme]") {
  Body<Averaged> body = body_of(box(), {liver});
  std::swap(body.mesh.elements[7][0], body.mesh.elements[7][1]);
  CHECK(refusal([&] { assemble_stiffness<Averaged>(body, {}); }).ids == std::vector<std::int64_t>{7});
  CHECK_REFUSED(SetupErrorKind::inverted_element, assemble_stiffness<Averaged>(body, {}));
  body.mesh.positions[3][1] = std::numeric_limits<double>::quiet_NaN();
  std::swap(body.mesh.elements[7][0], body.mesh.elements[7][1]);
  CHECK_REFUSED(SetupErrorKind::non_finite, assemble_stiffness<Averaged>(body, {}));
  CHECK_REFUSED(SetupErrorKind::non_finite, (detail::MatrixFreeStiffness<Averaged>(body, {})));
}
