// Co-rotated tetrahedra without a matrix: force, energy and stiffness equal those of the material, element by element.
#include <palpate/assembly/detail/corotated_tetrahedra.hpp>
#include <palpate/assembly/large_strain.hpp>

#include <Eigen/Geometry>
#include <numbers>

#include "assembly/bodies.hpp"
#include "material/semidefinite_tangent.hpp"

using namespace test;

namespace {

using Law = Corotational;

/// A block in two regions, with displaced inner nodes.
HyperelasticBody<Tet4, Law> rotational_block(std::array<int, 3> cells) {
  Mesh<Tet4> mesh = jittered(box_tet4(Vector3(0.1, 0.08, 0.06), cells, BoxSplit::six), 0.002, Vector3(0.1, 0.08, 0.06));
  mesh.region_names = {"below", "above"};
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.regions.push_back(element_nodes<Tet4>(mesh, e).col(2).mean() > 0.03 ? 1 : 0);
  return make_hyperelastic_body<Tet4, Law>(std::move(mesh), std::vector<Law>{{3e3, 0.4, 1000.0}, {15e3, 0.3, 1000.0}});
}
VectorX wild(Index dofs, double amount) {
  testing::Random random(5);
  VectorX u(dofs);
  for (double& x : u) x = random.uniform(-amount, amount);
  return u;
}
/// Rotated about the origin, then displaced and deformed.
VectorX rotated(const Mesh<Tet4>& mesh, const Matrix3& r, const VectorX& u) {
  VectorX t(u.size());
  for (Index i = 0; i < mesh.node_count(); ++i)
    t.segment<3>(3 * i) = r * (mesh.position(i) + u.segment<3>(3 * i)) - mesh.position(i);
  return t;
}
double apart(const VectorX& a, const VectorX& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// sum over elements of V grad N_a . A . grad N_b x_b with the material's tangent at fixed rotation.
VectorX plain_product(const HyperelasticBody<Tet4, Law>& body, const VectorX& u, const VectorX& x) {
  VectorX y = VectorX::Zero(x.size());
  const Mesh<Tet4>& mesh = body.rest.mesh;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const auto g = detail::constant_geometry<Tet4>(mesh, e);
    Eigen::Matrix<double, 3, 4> ue, xe;
    for (int a = 0; a < 4; ++a) {
      ue.col(a) = u.segment<3>(3 * Index{mesh.element_node(e, a)});
      xe.col(a) = x.segment<3>(3 * Index{mesh.element_node(e, a)});
    }
    const Matrix3 f = Matrix3::Identity() + ue * g.gradient, df = xe * g.gradient;
    const Eigen::Matrix<double, 9, 1> dp =
        semidefinite_tangent(body.materials[body.rest.region_of(e)], tensor3<double>(f)) * vector9(tensor3<double>(df));
    const Eigen::Matrix<double, 3, 4> fe = g.volume * Eigen::Map<const Matrix3>(dp.data()) * g.gradient.transpose();
    for (int a = 0; a < 4; ++a) y.segment<3>(3 * Index{mesh.element_node(e, a)}) += fe.col(a);
  }
  return y;
}

template <class S>
void compare(const HyperelasticBody<Tet4, Law>& body, const VectorX& u, double tolerance) {
  const LargeStrain<Tet4, Law> plain(body);
  detail::CorotatedTetrahedra<S> batched(body);
  VectorX exact(u.size()), f(u.size()), y(u.size());
  double energy = 0.0;
  const DeformationReport wanted = plain.force(u, exact), got = batched.linearise(u, f, energy);
  CHECK(apart(f, exact) <= tolerance);
  CHECK(std::abs(energy / plain.energy(u) - 1.0) <= tolerance);
  CHECK(std::abs(got.smallest_volume_ratio - wanted.smallest_volume_ratio) <= tolerance);
  CHECK(got.worst_element == wanted.worst_element);
  CHECK(got.inverted == wanted.inverted);
  const VectorX x = wild(u.size(), 1.0);
  batched.apply(x, y);
  CHECK(apart(y, plain_product(body, u, x)) <= tolerance);
}

}  // namespace

TEST_CASE("co-rotated batches give force, energy and product of the material", "[assembly][corotated]") {
  const Matrix3 rotation = Eigen::AngleAxisd(2.5, Vector3(1, 2, -1).normalized()).toRotationMatrix();
  for (const std::array<int, 3> cells : {std::array{1, 1, 1}, {2, 1, 3}, {5, 4, 3}, {9, 8, 7}}) {
    const auto body = rotational_block(cells);
    const VectorX small = wild(3 * body.rest.mesh.node_count(), 0.001);
    INFO(body.rest.mesh.element_count() << " elements");
    for (const VectorX& u : {small, rotated(body.rest.mesh, rotation, small)}) {
      compare<double>(body, u, 1e-12);
      compare<float>(body, u, 5e-5);
    }
  }
}

TEST_CASE("co-rotated batches follow a motion with inverted elements", "[assembly][corotated][E5]") {
  const auto body = rotational_block({3, 3, 3});
  const LargeStrain<Tet4, Law> plain(body);
  detail::CorotatedTetrahedra<double> batched(body);
  const VectorX path = wild(3 * body.rest.mesh.node_count(), 0.03);
  VectorX f(path.size()), exact(path.size());
  double energy = 0.0, worst = 0.0;
  Index inverted = 0;
  for (int k = 0; k <= 60; ++k) {
    const VectorX u = std::sin(0.1 * k) * path;
    inverted = std::max(inverted, batched.linearise(u, f, energy).inverted);
    plain.force(u, exact);
    worst = std::max(worst, (f - exact).cwiseAbs().maxCoeff());
  }
  CHECK(inverted > 10);
  CHECK(worst <= 1e-10 * exact.cwiseAbs().maxCoeff());
}

TEST_CASE("a rigid rotation causes no force, at all angles including exactly 180 degrees",
          "[assembly][corotated][E4]") {
  const auto body = rotational_block({4, 3, 2});
  const Mesh<Tet4>& mesh = body.rest.mesh;
  const VectorX rest = VectorX::Zero(3 * mesh.node_count());
  const double unit = 15e3 * 0.025 * 0.025;  // E h^2
  detail::CorotatedTetrahedra<double> batched(body);
  detail::CorotatedTetrahedra<float> single(body);
  VectorX f(rest.size());
  double energy = 0.0, worst = 0.0, worst_single = 0.0;
  const auto look = [&](const Matrix3& r) {
    const VectorX u = rotated(mesh, r, rest);
    batched.linearise(u, f, energy);
    worst = std::max(worst, f.cwiseAbs().maxCoeff());
    single.linearise(u, f, energy);
    worst_single = std::max(worst_single, f.cwiseAbs().maxCoeff());
  };
  for (int degrees = 0; degrees <= 360; degrees += 3)
    for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, -2, 3)})
      look(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis.normalized()).toRotationMatrix());
  for (int i = 0; i < 3; ++i) look(2.0 * Vector3::Unit(i) * Vector3::Unit(i).transpose() - Matrix3::Identity());
  CHECK(worst <= 1e-10 * unit);
  CHECK(worst_single <= 1e-4 * unit);
}

TEST_CASE("the diagonal blocks equal those of the product", "[assembly][corotated]") {
  const auto body = rotational_block({2, 2, 2});
  detail::CorotatedTetrahedra<double> batched(body);
  const Index dofs = batched.size();
  VectorX f(dofs), straight(dofs), mixed(dofs), e = VectorX::Zero(dofs), y(dofs);
  double energy = 0.0;
  batched.linearise(wild(dofs, 0.02), f, energy);
  batched.diagonal_blocks(straight, mixed);
  double worst = 0.0;
  for (Index i = 0; i < dofs / 3; ++i)
    for (int c = 0; c < 3; ++c) {
      e[3 * i + c] = 1.0;
      batched.apply(e, y);
      e[3 * i + c] = 0.0;
      for (int r = 0; r < 3; ++r)  // of xy, xz, yz the entry (r, c) is number r + c - 1
        worst = std::max(worst, std::abs(y[3 * i + r] - (r == c ? straight[3 * i + c] : mixed[3 * i + r + c - 1])));
    }
  CHECK(worst <= 1e-12 * straight.maxCoeff());
}

TEST_CASE("the product is symmetric and positive semidefinite in every state", "[assembly][corotated][E5]") {
  const auto body = rotational_block({3, 2, 2});
  detail::CorotatedTetrahedra<double> batched(body);
  const Index dofs = batched.size();
  VectorX f(dofs), kx(dofs), ky(dofs);
  double energy = 0.0;
  testing::Random random(9);
  for (const double amount : {0.0, 0.01, 0.1, 10.0}) {
    batched.linearise(wild(dofs, amount), f, energy);
    for (int k = 0; k < 10; ++k) {
      const VectorX x = VectorX::NullaryExpr(dofs, [&] { return random.uniform(-1.0, 1.0); });
      const VectorX y = VectorX::NullaryExpr(dofs, [&] { return random.uniform(-1.0, 1.0); });
      batched.apply(x, kx);
      batched.apply(y, ky);
      CHECK(std::abs(x.dot(ky) - y.dot(kx)) <= 1e-12 * std::abs(x.dot(kx)));
      CHECK(x.dot(kx) >= 0.0);
    }
  }
}

TEST_CASE("non-finite states are reported, without effect on the next state", "[assembly][corotated]") {
  const auto body = rotational_block({3, 2, 2});
  detail::CorotatedTetrahedra<float> batched(body);
  VectorX u = wild(batched.size(), 0.001), f(u.size()), again(u.size());
  double energy = 0.0;
  batched.linearise(u, f, energy);
  for (const double bad : {std::nan(""), infinity}) {
    VectorX broken = u;
    broken[10] = bad;
    CHECK_FALSE(batched.linearise(broken, again, energy).admissible);
    CHECK(batched.linearise(u, again, energy).admissible);
    CHECK(apart(again, f) <= 1e-5);
  }
}

TEST_CASE("co-rotated batches refuse invalid meshes and materials", "[assembly][corotated]") {
  auto body = rotational_block({2, 2, 2});
  body.materials[1].poisson_ratio = 0.5;
  CHECK_REFUSED(SetupErrorKind::bad_poisson_ratio, detail::CorotatedTetrahedra<>{body});
  body.materials[1].poisson_ratio = 0.4;
  std::swap(body.rest.mesh.elements[7][0], body.rest.mesh.elements[7][1]);
  CHECK_REFUSED(SetupErrorKind::inverted_element, detail::CorotatedTetrahedra<>{body});
}
