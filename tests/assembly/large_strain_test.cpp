// Energy, force and tangent at any deformation, against closed forms, differences and motions.
#include <palpate/assembly/large_strain.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/testing/random.hpp>

#include <numbers>

#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>

#include <Eigen/Geometry>

#include "assembly/bodies.hpp"

using namespace test;
using Catch::Matchers::WithinRel;

namespace {

constexpr NeoHookean gel{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1e3};

/// Counts its tangents.
struct CountedMooneyRivlin : MooneyRivlin {
  static inline long tangents = 0;
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    ++tangents;
    return MooneyRivlin::tangent(f);
  }
};

template <Element E>
Mesh<E> crooked_box() {
  Mesh<E> mesh;
  if constexpr (E::nodes == 4) mesh = box_tet4({0.3, 0.2, 0.1}, {2, 2, 2});
  if constexpr (E::nodes == 8) mesh = box_hex8({0.3, 0.2, 0.1}, {2, 2, 2});
  if constexpr (E::nodes == 10) mesh = box_tet10({0.3, 0.2, 0.1}, {2, 1, 1});
  if constexpr (E::nodes == 20) mesh = box_hex20({0.3, 0.2, 0.1}, {1, 1, 1});
  for (Vector3& x : mesh.positions)  // a smooth bend that inverts no element
    x += Vector3(0.1 * x[1] * x[2], 0.2 * x[0] * x[0], 0.3 * x[0] * x[1]);
  return mesh;
}

template <Element E, class M = NeoHookean>
LargeStrain<E, M> elastic(const M& material = M{5e3, 0.4, 1e3}) {
  return LargeStrain<E, M>(make_hyperelastic_body(crooked_box<E>(), std::vector<M>{material}));
}

VectorX random_vector(Index n, double size, std::uint64_t seed) {
  testing::Random random(seed);
  VectorX v(n);
  for (double& x : v) x = random.uniform(-size, size);
  return v;
}

/// Displacement of the motion x -> a x + c.
template <Element E>
VectorX affine(const Mesh<E>& mesh, const Matrix3& a, const Vector3& c) {
  VectorX u(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = a * mesh.position(i) + c - mesh.position(i);
  return u;
}

}  // namespace

TEMPLATE_TEST_CASE("force and tangent are derivatives of the energy", "[assembly][large_strain]", Tet4, Tet10, Hex8,
                   Hex20) {
  const auto body = elastic<TestType>();
  const Index n = body.size();
  const VectorX u = random_vector(n, 5e-3, 1), d = random_vector(n, 1.0, 2);
  VectorX f(n), ahead(n), behind(n), kd(n);
  const DeformationReport report = body.force(u, f);
  CHECK(report.admissible);
  CHECK(report.smallest_volume_ratio < 1.0);
  const double h = 1e-6;
  CHECK_THAT((body.energy(u + h * d) - body.energy(u - h * d)) / (2.0 * h), WithinRel(f.dot(d), 1e-7));
  BlockMatrix k(detail::block_pattern(body.mesh()));
  body.tangent(u, k);
  body.tangent(u, k);  // overwrites
  k.apply(d, kd);
  body.force(u + h * d, ahead);
  body.force(u - h * d, behind);
  CHECK(((ahead - behind) / (2.0 * h) - kd).norm() <= 1e-7 * kd.norm());
}

TEMPLATE_TEST_CASE("a homogeneous deformation equals the closed form", "[assembly][large_strain]", Tet4, Tet10, Hex8,
                   Hex20) {
  const auto body = elastic<TestType>();
  Matrix3 a;
  a << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, -0.2, 0.1, 1.1;
  const VectorX u = affine(body.mesh(), a, {0.1, -2.0, 3.0});
  double volume = 0.0;
  for (Index e = 0; e < body.mesh().element_count(); ++e)
    for (const auto& p : detail::integration_points<TestType>(element_nodes<TestType>(body.mesh(), e)))
      volume += p.volume;
  CHECK_THAT(body.energy(u), WithinRel(volume * gel.energy(tensor3<double>(a)), 1e-12));
  VectorX f(u.size());
  const DeformationReport report = body.force(u, f);
  CHECK_THAT(report.smallest_volume_ratio, WithinRel(a.determinant(), 1e-11));
  CHECK(report.inverted == 0);
  Matrix3 moment = Matrix3::Zero();  // sum f x^T = V P
  for (Index i = 0; i < body.mesh().node_count(); ++i)
    moment += f.segment<3>(3 * i) * body.mesh().position(i).transpose();
  const Matrix3 p = matrix3(gel.stress(tensor3<double>(a)));
  CHECK((moment - volume * p).norm() <= 1e-12 * volume * p.norm());
}

TEMPLATE_TEST_CASE("a rigid motion needs no energy and rotates the forces", "[assembly][large_strain]", Tet4, Tet10,
                   Hex8, Hex20) {
  const auto body = elastic<TestType>();
  const Index n = body.size();
  const VectorX u = random_vector(n, 5e-3, 3);
  VectorX f(n), g(n);
  body.force(u, f);
  const double size = f.cwiseAbs().maxCoeff();
  for (const double degrees : {1.0, 90.0, 179.0, 180.0, 181.0, 359.0}) {
    const Matrix3 r =
        Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vector3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    const Vector3 c(0.2, 0.1, -0.3);
    body.force(affine(body.mesh(), r, c), g);
    CHECK(g.cwiseAbs().maxCoeff() <= 1e-10 * 5e3 * 0.1 * 0.1);  // EXTREMES E4: of E h^2
    VectorX v(n);
    for (Index i = 0; i < n / 3; ++i)
      v.segment<3>(3 * i) = r * (body.mesh().position(i) + u.segment<3>(3 * i)) + c - body.mesh().position(i);
    body.force(v, g);
    double worst = 0.0;
    for (Index i = 0; i < n / 3; ++i) worst = std::max(worst, (g.segment<3>(3 * i) - r * f.segment<3>(3 * i)).norm());
    CHECK(worst <= 1e-11 * size);
    CHECK_THAT(body.energy(v), WithinRel(body.energy(u), 1e-10));
  }
  Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
  for (Index i = 0; i < n / 3; ++i) {
    const Vector3 x = body.mesh().position(i) + u.segment<3>(3 * i);
    sum += f.segment<3>(3 * i);
    moment += x.cross(f.segment<3>(3 * i));
  }
  CHECK(sum.norm() <= 1e-13 * size * static_cast<double>(n));
  CHECK(moment.norm() <= 1e-13 * size * static_cast<double>(n));
}

TEMPLATE_TEST_CASE("at rest the tangent equals the small-strain stiffness", "[assembly][large_strain]", Tet4, Tet10,
                   Hex8, Hex20) {
  const auto body = elastic<TestType>();
  const VectorX d = random_vector(body.size(), 1.0, 4);
  BlockMatrix k(detail::block_pattern(body.mesh()));
  body.tangent(VectorX::Zero(d.size()), k);
  VectorX a(d.size()), b(d.size());
  k.apply(d, a);
  assemble_stiffness<TestType>(body.body().rest, {}).apply(d, b);
  CHECK((a - b).norm() <= 1e-13 * b.norm());
}

TEST_CASE("inverted elements are counted, and inadmissible materials are reported",
          "[assembly][large_strain][extreme][E5]") {
  const auto soft = elastic<Tet4>();
  const auto barred = elastic<Tet4, NeoHookeanLogarithmic>({5e3, 0.4, 1e3});
  const Index n = soft.size();
  VectorX f(n);
  for (const double height : {-1.0, 0.0}) {
    const VectorX u = affine(soft.mesh(), Vector3(1.0, 1.0, height).asDiagonal(), Vector3::Zero());
    const DeformationReport report = soft.force(u, f);
    CHECK(report.inverted > 0);
    CHECK(std::abs(report.smallest_volume_ratio - height) <= 1e-12);
    CHECK(report.admissible);
    CHECK(f.allFinite());
    CHECK(std::isfinite(soft.energy(u)));
    CHECK_FALSE(barred.force(u, f).admissible);
    CHECK(f.allFinite());
    CHECK(barred.energy(u) == infinity);
  }
  VectorX one = VectorX::Zero(n);  // a single node pushed through the opposite side of its elements
  const Index node = soft.mesh().element_node(0, 0);
  one.segment<3>(3 * node) = Vector3(0.0, 0.0, 1.0);
  const DeformationReport report = soft.force(one, f);
  CHECK(report.inverted > 0);
  CHECK(report.inverted < soft.mesh().element_count());
  CHECK(report.smallest_volume_ratio < 0.0);
  CHECK(report.worst_element >= 0);
}

TEST_CASE("a mesh with inverted elements at rest is refused", "[assembly][large_strain]") {
  Mesh<Tet4> mesh = crooked_box<Tet4>();
  std::swap(mesh.elements[3][0], mesh.elements[3][1]);
  const SetupProblem problem =
      refusal([&] { LargeStrain<Tet4, NeoHookean>{make_hyperelastic_body(mesh, std::vector<NeoHookean>{gel})}; });
  CHECK(problem.kind == SetupErrorKind::inverted_element);
  CHECK(problem.ids == std::vector<Index>{3});
}

TEST_CASE("a law without a rule for its range is examined at most once per element and force", "[assembly]") {
  const Mesh<Tet10> mesh = crooked_box<Tet10>();
  const LargeStrain<Tet10, CountedMooneyRivlin> body(
      make_hyperelastic_body(mesh, std::vector{CountedMooneyRivlin{{600.0, 200.0, 4e4, 1e3}}}));
  VectorX u(3 * mesh.node_count()), f(u.size());
  const auto tangents_at = [&](double stretch) {
    for (Index i = 0; i < mesh.node_count(); ++i)
      set_node_vector(u, i, Vector3((stretch - 1.0) * mesh.position(i)[0], 0.0, 0.0));
    CountedMooneyRivlin::tangents = 0;
    body.force(u, f);
    return CountedMooneyRivlin::tangents;
  };
  CHECK(tangents_at(1.05) == 0);
  CHECK(tangents_at(1.6) == mesh.element_count());
}
