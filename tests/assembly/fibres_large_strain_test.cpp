// Fibre directions of the mesh at large strain: every element has its own.
#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/material/fibre_reinforced.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>

#include "assembly/bodies.hpp"

using namespace test;

namespace {

using FibredGel = FibreReinforced<NeoHookean>;
const FibredGel fibred_gel{NeoHookean{5e3, 0.4, 1e3}, 2e4, 0.7, Vector3::UnitX()};

template <Element E>
Mesh<E> block_of_fibres(bool alike) {
  Mesh<E> mesh;
  if constexpr (E::nodes == 4) mesh = box_tet4({0.3, 0.2, 0.1}, {2, 2, 2}, BoxSplit::six);
  if constexpr (E::nodes == 8) mesh = box_hex8({0.3, 0.2, 0.1}, {2, 2, 2});
  testing::Random random(12);
  const Vector3 first = random.vector<3>(-1.0, 1.0).normalized();
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.fibres.push_back(alike ? first : random.vector<3>(-1.0, 1.0).normalized());
  return mesh;
}

template <Element E>
LargeStrain<E, FibredGel> pulled_along(const Mesh<E>& mesh, const FibredGel& material = fibred_gel) {
  return LargeStrain<E, FibredGel>(make_hyperelastic_body(mesh, std::vector<FibredGel>{material}));
}

VectorX stirred(Index dofs, double amount) {
  testing::Random random(31);
  VectorX u(dofs);
  for (double& x : u) x = random.uniform(-amount, amount);
  return u;
}

}  // namespace

TEMPLATE_TEST_CASE("rotating body and fibres rotates the forces (large strain)", "[assembly][large_strain][fibres]",
                   Tet4, Hex8) {
  const Mesh<TestType> mesh = block_of_fibres<TestType>(false);
  testing::Random random(5);
  const Matrix3 r = testing::random_rotation(random);
  Mesh<TestType> rotated = mesh, fibres_left = mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    rotated.positions[i] = fibres_left.positions[i] = r * mesh.positions[i];
  for (Vector3& fibre : rotated.fibres) fibre = r * fibre;
  const VectorX u = stirred(3 * mesh.node_count(), 5e-3);
  VectorX v(u.size()), f(u.size()), g(u.size()), h(u.size()), rotated_f(u.size());
  for (Index i = 0; i < mesh.node_count(); ++i) v.segment<3>(3 * i) = r * u.segment<3>(3 * i);
  const auto body = pulled_along(mesh), rotated_body = pulled_along(rotated);
  body.force(u, f);
  rotated_body.force(v, g);
  pulled_along(fibres_left).force(v, h);
  for (Index i = 0; i < mesh.node_count(); ++i) rotated_f.segment<3>(3 * i) = r * f.segment<3>(3 * i);
  CHECK((g - rotated_f).cwiseAbs().maxCoeff() <= 1e-12 * f.cwiseAbs().maxCoeff());
  CHECK((h - rotated_f).cwiseAbs().maxCoeff() >= 1e-2 * f.cwiseAbs().maxCoeff());
  CHECK(std::abs(body.energy(u) - rotated_body.energy(v)) <= 1e-12 * body.energy(u));
}

TEST_CASE("with fibres, force and tangent are derivatives of energy and force", "[assembly][large_strain][fibres]") {
  const auto body = pulled_along(block_of_fibres<Tet4>(false));
  const VectorX u = stirred(body.size(), 5e-3), d = stirred(body.size(), 1.0).cwiseProduct(u.cwiseSign());
  const double h = 1e-7;
  VectorX f(u.size()), more(u.size()), less(u.size()), kd(u.size());
  body.force(u, f);
  const double slope = (body.energy(u + h * d) - body.energy(u - h * d)) / (2.0 * h);
  CHECK(std::abs(f.dot(d) - slope) <= 1e-6 * f.norm() * d.norm());
  BlockMatrix k(detail::block_pattern(body.mesh()));
  body.tangent(u, k);
  k.apply(d, kd);
  body.force(u + h * d, more);
  body.force(u - h * d, less);
  CHECK((kd - (more - less) / (2.0 * h)).norm() <= 1e-6 * kd.norm());
}

TEST_CASE("mesh fibres override the material's own; equal ones give the same result",
          "[assembly][large_strain][fibres]") {
  Mesh<Tet4> mesh = block_of_fibres<Tet4>(true);
  FibredGel own = fibred_gel;
  own.fibre = mesh.fibres.front();
  const auto by_mesh = pulled_along(mesh);
  mesh.fibres.clear();
  const auto by_law = pulled_along(mesh, own), along_x = pulled_along(mesh);
  const VectorX u = stirred(by_mesh.size(), 5e-3);
  VectorX f(u.size()), g(u.size()), other(u.size());
  by_mesh.force(u, f);
  by_law.force(u, g);
  along_x.force(u, other);
  CHECK((f - g).cwiseAbs().maxCoeff() <= 1e-13 * g.cwiseAbs().maxCoeff());
  CHECK((f - other).cwiseAbs().maxCoeff() >= 1e-2 * g.cwiseAbs().maxCoeff());
  by_mesh.force(VectorX::Zero(u.size()), f);
  CHECK(f.cwiseAbs().maxCoeff() <= 1e-14 * g.cwiseAbs().maxCoeff());
}

TEST_CASE("unsupported and invalid fibres are refused", "[assembly][large_strain][fibres][extreme]") {
  Mesh<Tet4> mesh = block_of_fibres<Tet4>(false);
  const auto body = make_hyperelastic_body(mesh, std::vector<FibredGel>{fibred_gel});
  CHECK_REFUSED(SetupErrorKind::unsupported, BatchedTetrahedra<FibredGel>{body});
  // a material without a direction ignores fibres
  CHECK(BatchedTetrahedra<NeoHookean>(make_hyperelastic_body(mesh, std::vector<NeoHookean>{fibred_gel.base})).size() ==
        3 * mesh.node_count());
  mesh.fibres[3] *= 0.5;
  CHECK_REFUSED(SetupErrorKind::bad_argument, pulled_along(mesh));
  mesh.fibres.pop_back();
  CHECK_REFUSED(SetupErrorKind::bad_argument, pulled_along(mesh));
}

TEST_CASE("materials by region number: one per region, each admissible", "[assembly][large_strain][extreme]") {
  Mesh<Tet4> mesh = box_tet4({0.3, 0.2, 0.1}, {2, 2, 2});
  mesh.region_names = {"below", "above"};
  for (Index e = 0; e < mesh.element_count(); ++e) mesh.regions.push_back(static_cast<int>(e % 2));
  const NeoHookean good{5e3, 0.4, 1e3}, bad{5e3, 0.5, 1e3};
  const LinearElastic hard{5e3, 0.4, 1e3}, none{-5e3, 0.4, 1e3};
  const auto large = [&](std::vector<NeoHookean> laws) { make_hyperelastic_body(mesh, std::move(laws)); };
  const auto small = [&](const std::vector<LinearElastic>& laws) { make_body(mesh, laws); };
  large({good, good});
  small({hard, hard});
  CHECK_REFUSED(SetupErrorKind::missing_material, large({good}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, large({good, good, good}));
  CHECK_REFUSED(SetupErrorKind::bad_poisson_ratio, large({good, bad}));
  CHECK_REFUSED(SetupErrorKind::missing_material, small({}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, small({hard, hard, hard}));
  CHECK_REFUSED(SetupErrorKind::bad_youngs_modulus, small({hard, none}));
  const SetupProblem problem = refusal([&] { large({good, bad}); });
  CHECK(problem.ids == std::vector<std::int64_t>{1});
  CHECK(problem.what.find("above") != std::string::npos);
}
