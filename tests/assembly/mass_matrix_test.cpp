// The mass of whole bodies.
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/generators_box.hpp>

#include <Eigen/Geometry>

#include "assembly/bodies.hpp"
#include "assembly/csv.hpp"
#include "mesh/two_cubes.hpp"

using namespace test;
using Catch::Matchers::WithinRel;

namespace {

template <Element E>
Mesh<E> box(const Vector3& size, std::array<int, 3> cells) {
  if constexpr (E::nodes == 4) return box_tet4(size, cells);
  if constexpr (E::nodes == 8) return box_hex8(size, cells);
  if constexpr (E::nodes == 10) return box_tet10(size, cells);
  if constexpr (E::nodes == 20) return box_hex20(size, cells);
}

/// v M v for the velocity field v(x) at every node.
template <Element E>
double twice_kinetic_energy(const Mesh<E>& mesh, const detail::MassMatrix& m,
                            const std::function<Vector3(const Vector3&)>& v) {
  VectorX nodal(m.size()), moved(m.size());
  for (Index i = 0; i < mesh.node_count(); ++i) nodal.segment<3>(3 * i) = v(mesh.position(i));
  m.apply(nodal, moved);
  return nodal.dot(moved);
}

}  // namespace

TEMPLATE_TEST_CASE("total mass and inertia of a block", "[assembly][mass]", Tet4, Tet10, Hex8, Hex20) {
  using E = TestType;
  const Vector3 size(0.3, 0.2, 0.1), origin(1.0, -2.0, 0.5);
  Mesh<E> mesh = box<E>(size, {3, 2, 2});
  for (Vector3& x : mesh.positions) x += origin;
  const Body<E> body = body_of(std::move(mesh), {liver});
  const detail::MassMatrix m = assemble_mass(body);
  const double mass = liver.density * size.prod();

  const Vector3 along(0.3, -0.4, 1.2);  // norm 1.3
  CHECK_THAT(twice_kinetic_energy(body.mesh, m, [&](const Vector3&) { return along; }), WithinRel(1.69 * mass, 1e-12));

  // Koenig: a rotation w about p has the energy of its centre plus that of its own inertia, m/12 (b^2 + c^2) per axis.
  const Vector3 w(2.0, -1.0, 3.0), p(0.1, 0.2, 0.3), centre = origin + 0.5 * size, s = size.cwiseAbs2();
  const Vector3 inertia = mass / 12.0 * Vector3(s[1] + s[2], s[0] + s[2], s[0] + s[1]);
  const double exact = mass * w.cross(centre - p).squaredNorm() + w.cwiseAbs2().dot(inertia);
  CHECK_THAT(twice_kinetic_energy(body.mesh, m, [&](const Vector3& x) { return w.cross(x - p); }),
             WithinRel(exact, 1e-12));

  const VectorX lumped = lumped_mass(body);
  CHECK(lumped.minCoeff() > 0.0);
  CHECK_THAT(lumped.sum(), WithinRel(mass, 1e-12));
  CHECK_THAT(nodal_mass(body).sum(), WithinRel(mass, 1e-12));
}

TEST_CASE("the mass of two cubes equals that of another code", "[assembly][mass][oracle]") {
  const MatrixX reference = read_matrix(two_cubes_folder + "M_consistent_getfem.csv");
  if (reference.size() == 0) {
    WARN("skipped: no reference in the tree");
    return;
  }
  const detail::MassMatrix m = assemble_mass(body_of(two_cubes(), {reference_material}));
  REQUIRE(reference.rows() == m.size());
  MatrixX dense(m.size(), m.size());
  VectorX column(m.size());
  for (Index i = 0; i < m.size(); ++i) {
    m.apply(VectorX::Unit(m.size(), i), column);
    dense.col(i) = column;
  }
  CHECK((dense - reference).cwiseAbs().maxCoeff() <= 1e-11 * reference.cwiseAbs().maxCoeff());
}

TEST_CASE("mass follows the density of the region", "[assembly][mass]") {
  LinearElastic light = reference_material, heavy = reference_material;
  light.density = 2.0;
  heavy.density = 7.0;
  const Body<Tet4> body = body_of(two_cubes(), {light, heavy});  // two cubes of volume 1
  CHECK_THAT(lumped_mass(body).sum(), WithinRel(9.0, 1e-14));
  CHECK_THAT(twice_kinetic_energy(body.mesh, assemble_mass(body), [](const Vector3&) { return Vector3(1, 0, 0); }),
             WithinRel(9.0, 1e-14));
}

TEMPLATE_TEST_CASE("mass does not depend on the order of nodes and elements", "[assembly][mass]", Tet4, Tet10, Hex20) {
  using E = TestType;
  const Body<E> body = body_of(box<E>({0.3, 0.2, 0.1}, {2, 2, 1}), {liver});
  const auto n = static_cast<std::size_t>(body.mesh.node_count());
  std::vector<NodeId> map(n);
  for (std::size_t i = 0; i < n; ++i) map[i] = static_cast<NodeId>((7 * i + 3) % n);
  REQUIRE(n % 7 != 0);
  Body<E> other = body;
  detail::renumber_nodes(other.mesh, map);
  std::ranges::reverse(other.mesh.elements);
  const VectorX lumped = lumped_mass(body), other_lumped = lumped_mass(other);
  VectorX v(3 * body.mesh.node_count()), other_v = v, mv = v, other_mv = v;
  for (Index i = 0; i < v.size(); ++i) v[i] = std::sin(static_cast<double>(i * i));
  for (std::size_t i = 0; i < n; ++i)
    other_v.template segment<3>(3 * map[i]) = v.template segment<3>(3 * static_cast<Index>(i));
  assemble_mass(body).apply(v, mv);
  assemble_mass(other).apply(other_v, other_mv);
  for (std::size_t i = 0; i < n; ++i) {
    CHECK_THAT(other_lumped[map[i]], WithinRel(lumped[static_cast<Index>(i)], 1e-13));
    const Vector3 difference =
        other_mv.template segment<3>(3 * map[i]) - mv.template segment<3>(3 * static_cast<Index>(i));
    CHECK(difference.norm() <= 1e-13 * mv.norm());
  }
}

TEST_CASE("the mass of the free dofs is part of the full mass matrix", "[assembly][mass]") {
  const Body<Tet10> body = body_of(box<Tet10>({0.3, 0.2, 0.1}, {2, 1, 1}), {liver});
  Scene scene;
  scene.prescribe("x0", {0.0, std::nullopt, 0.0});
  const EssentialConditions conditions = conditions_of(body.mesh, scene);
  const detail::MassMatrix m = assemble_mass(body);
  const SparseMatrix lower = free_matrix(m, conditions);
  VectorX free(conditions.free_count()), full(m.size()), moved(m.size()), expected(free.size());
  for (Index i = 0; i < free.size(); ++i) free[i] = std::cos(static_cast<double>(i));
  conditions.scatter(free, full);
  m.apply(full, moved);
  conditions.gather(moved, expected);
  const VectorX product = lower.selfadjointView<Eigen::Lower>() * free;
  CHECK((product - expected).norm() <= 1e-14 * expected.norm());
}

TEST_CASE("inverted elements and non-finite masses are refused", "[assembly][mass]") {
  Body<Tet4> inverted = body_of(two_cubes(), {reference_material});
  std::swap(inverted.mesh.elements[4][0], inverted.mesh.elements[4][1]);
  CHECK_REFUSED(SetupErrorKind::inverted_element, assemble_mass(inverted));
  CHECK(refusal([&] { lumped_mass(inverted); }).ids == std::vector<std::int64_t>{4});
  Body<Tet4> unknown = body_of(two_cubes(), {reference_material});
  unknown.density.back() = std::numeric_limits<double>::quiet_NaN();
  CHECK_REFUSED(SetupErrorKind::non_finite, assemble_mass(unknown));
  CHECK_REFUSED(SetupErrorKind::non_finite, lumped_mass(unknown));
  SetupLimits small;
  small.memory = 100;
  CHECK_REFUSED(SetupErrorKind::too_large, assemble_mass(body_of(two_cubes(), {liver}), small));
}
