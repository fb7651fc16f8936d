// Stress at points and recovered at nodes, against fields with known stress.
#include <palpate/post/patch_recovery.hpp>
#include <palpate/post/stress.hpp>

#include "../../benchmarks/accuracy/lame_sphere.hpp"

#include "catch.hpp"

using namespace palpate;
using accuracy::body_of, accuracy::box_of, accuracy::jittered;

namespace {

using Cured = MeanDilatation<Hex8>;
constexpr LinearElastic soft{.youngs_modulus = 5e3, .poisson_ratio = 0.3};

template <Element E, class Field>
VectorX nodal_values(const Mesh<E>& mesh, Field field) {
  VectorX u(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = field(mesh.position(i));
  return u;
}

/// A polynomial displacement of degree 0 ... 3 with its strain.
struct Polynomial {
  int degree = 1;
  std::array<Vector3, 20> factors{};

  explicit Polynomial(int of_degree, std::uint64_t seed = 5) : degree(of_degree) {
    testing::Random random(seed);
    for (Vector3& f : factors) f = random.vector<3>(-1.0, 1.0);
  }
  template <class Visit>
  void each_term(Visit visit) const {
    std::size_t k = 0;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j)
        for (int l = 0; i + j + l <= degree; ++l) visit(factors[k++], std::array{i, j, l});
  }
  Vector3 operator()(const Vector3& x) const {
    Vector3 u = Vector3::Zero();
    each_term([&](const Vector3& f, const std::array<int, 3>& n) {
      u += f * std::pow(x[0], n[0]) * std::pow(x[1], n[1]) * std::pow(x[2], n[2]);
    });
    return u;
  }
  Vector6 strain(const Vector3& x) const {
    Matrix3 gradient = Matrix3::Zero();
    each_term([&](const Vector3& f, const std::array<int, 3>& n) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (n[c] == 0) continue;
        auto m = n;
        --m[c];
        gradient.col(static_cast<int>(c)) +=
            f * n[c] * std::pow(x[0], m[0]) * std::pow(x[1], m[1]) * std::pow(x[2], m[2]);
      }
    });
    return voigt::strain_vector(0.5 * (gradient + gradient.transpose()));
  }
};

/// Largest error of the recovered stress at any node, relative to the largest stress.
template <Element E, class Stress>
double worst_recovered(const Body<E>& body, const VectorX& u, Stress exact) {
  const NodalStress nodal = patch_recovery(body, u);
  double worst = 0.0, most = 0.0;
  for (Index i = 0; i < body.mesh.node_count(); ++i) {
    const Vector6 expected = exact(body.mesh.position(i));
    most = std::max(most, expected.cwiseAbs().maxCoeff());
    worst = std::max(worst, (nodal.at(i) - expected).cwiseAbs().maxCoeff());
  }
  return worst / std::max(most, 1.0);
}

template <Element E>
double polynomial_error(Mesh<E> mesh, int degree) {
  const Polynomial field(degree);
  const Body<E> body = body_of(std::move(mesh), {soft});
  return worst_recovered(body, nodal_values(body.mesh, field),
                         [&](const Vector3& x) -> Vector6 { return soft.elasticity() * field.strain(x); });
}

template <Element E>
double points_error(Mesh<E> mesh, int degree) {
  const Polynomial field(degree);
  const Body<E> body = body_of(std::move(mesh), {soft});
  const VectorX u = nodal_values(body.mesh, field);
  const detail::ElementStress<E> state(body, u);
  double worst = 0.0, volume = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e)
    for (const detail::StressPoint& point : state.points(e)) {
      volume += point.volume;
      worst = std::max(worst, (point.strain - field.strain(point.position)).cwiseAbs().maxCoeff());
      worst = std::max(worst, (point.stress - soft.elasticity() * point.strain).cwiseAbs().maxCoeff() / 5e3);
    }
  CHECK_THAT(volume, Catch::Matchers::WithinRel(1.0, 1e-12));
  return worst;
}

template <class... E, class Check>
void for_elements(Check check) {
  (check(std::type_identity<E>{}), ...);
}

}  // namespace

TEST_CASE("a stress of degree order - 1 is exact at all points and all nodes, on distorted meshes", "[post]") {
  for_elements<Tet4, Tet10, Hex8, Cured>([]<class E>(std::type_identity<E>) {
    INFO("nodes " << E::nodes);
    for (const std::array<int, 3>& cells : {std::array{3, 3, 3}, {2, 2, 2}, {1, 1, 1}, {4, 1, 1}, {1, 3, 2}}) {
      const auto mesh = jittered(box_of<E>({1, 1, 1}, cells), 0.05);
      for (int degree = 0; degree <= E::order; ++degree) {
        CHECK(points_error<E>(mesh, degree) <= 1e-12);
        const double error = polynomial_error<E>(mesh, degree);
        INFO(error);
        CHECK(error <= 2e-11);
      }
    }
  });
  for (int degree : {0, 1})
    CHECK(polynomial_error(jittered(box_of<Hex20>({1, 1, 1}, {3, 3, 3}), 0.05), degree) <= 1e-10);
  for (int degree : {0, 1, 2}) {
    CHECK(points_error(box_of<Hex20>({1, 1, 1}, {2, 3, 2}), degree) <= 1e-12);
    CHECK(polynomial_error(box_of<Hex20>({1, 1, 1}, {1, 1, 1}), degree) <= 1e-11);  // a single element
    CHECK(polynomial_error(box_of<Hex20>({1, 1, 1}, {4, 1, 1}), degree) <= 2e-11);
  }
}

TEST_CASE("on uniform meshes of hexahedra recovered stress is one order better than that of the element", "[post]") {
  CHECK(polynomial_error(box_of<Hex8>({1, 2, 3}, {4, 3, 2}), 2) <= 1e-12);
  CHECK(polynomial_error(box_of<Hex20>({1, 2, 3}, {3, 2, 2}), 3) <= 1e-12);
  // The same points are not exact without recovery.
  CHECK(points_error(box_of<Hex8>({1, 1, 1}, {3, 3, 3}), 2) > 1e-2);
}

TEST_CASE("MeanDilatation: points have the strain of the element formulation", "[post]") {
  testing::Random random(31);
  const Body<Cured> body = body_of(jittered(box_of<Cured>({1, 1, 1}, {2, 2, 2}), 0.1), {{5e3, 0.499, 1.0}});
  VectorX u(3 * body.mesh.node_count());
  for (Index i = 0; i < u.size(); ++i) u[i] = random.uniform(-0.1, 0.1);
  const detail::ElementStress<Cured> state(body, u);
  double energy = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto points = state.points(e);
    for (const detail::StressPoint& point : points) {
      CHECK_THAT(point.strain.head<3>().sum(), Catch::Matchers::WithinAbs(points[0].strain.head<3>().sum(), 1e-14));
      energy += 0.5 * point.volume * point.strain.dot(point.stress);
    }
  }
  CHECK_THAT(energy, Catch::Matchers::WithinRel(strain_energy(body, u), 1e-12));
}

TEST_CASE("recovery is more accurate than the mean around a node on a smooth field", "[post]") {
  const accuracy::LameSphere sphere;
  const auto errors = [&]<class E>(std::type_identity<E>, int n) {  // recovered, mean
    const Body<E> body = body_of(accuracy::sphere_octant<E>(1.0, 2.0, n, n), {sphere.material});
    const VectorX u = accuracy::solve_static(body, sphere.scene()).displacement;
    const auto exact = [&](const Vector3& x) { return sphere.stress(x); };
    const StressField mean = stress_field(body, u);
    double worst = 0.0;
    for (Index i = 0; i < body.mesh.node_count(); ++i)
      worst = std::max(worst, (mean.nodes.col(i) - exact(body.mesh.position(i))).cwiseAbs().maxCoeff());
    return std::pair{worst_recovered(body, u, exact), worst};  // the largest exact stress is one
  };
  for_elements<Tet4, Hex8, Cured, Tet10, Hex20>([&]<class E>(std::type_identity<E> element) {
    const int n = E::order == 1 ? 4 : 2;
    const auto [coarse, coarse_mean] = errors(element, n);
    const auto [fine, fine_mean] = errors(element, 2 * n);
    const double order = std::log2(coarse / fine);
    INFO("nodes " << E::nodes << ": recovered " << coarse << ' ' << fine << " order " << order << ", mean "
                  << coarse_mean << ' ' << fine_mean);
    CHECK(order > 0.85);  // at the worst node, on an edge
    CHECK(fine < 0.9 * fine_mean);
  });
}

TEST_CASE("stress jumps between two materials, and stays uniform on both sides", "[post]") {
  constexpr LinearElastic hard{.youngs_modulus = 5e6, .poisson_ratio = 0.2};
  for_elements<Tet4, Tet10, Hex8, Cured, Hex20>([&]<class E>(std::type_identity<E>) {
    Mesh<E> mesh = box_of<E>({1, 1, 2}, {2, 2, 4});
    mesh.region_names = {"soft", "hard"};
    for (Index e = 0; e < mesh.element_count(); ++e)
      mesh.regions.push_back(element_nodes<E>(mesh, e).col(2).mean() > 1.0 ? 1 : 0);
    const Body<E> body = body_of(mesh, {soft, hard});
    // Uniaxial strain in two layers: the same pressure, different strain, different lateral stress.
    const auto modulus = [](const LinearElastic& m) { return m.lame_lambda() + 2.0 * m.shear_modulus(); };
    const auto field = [&](const Vector3& x) -> Vector3 {
      return {0, 0, -std::min(x[2], 1.0) / modulus(soft) - std::max(x[2] - 1.0, 0.0) / modulus(hard)};
    };
    const NodalStress nodal = patch_recovery(body, nodal_values(mesh, field));
    int twice = 0;
    for (Index i = 0; i < mesh.node_count(); ++i)
      for (int r : {0, 1}) {
        const Index k = nodal.column(i, r);
        const bool touches = r == 0 ? mesh.position(i)[2] <= 1.0 : mesh.position(i)[2] >= 1.0;
        CHECK((k >= 0) == touches);
        if (k < 0) continue;
        const LinearElastic& m = r == 0 ? soft : hard;
        const double across = -m.lame_lambda() / modulus(m);
        CHECK((nodal.stress.col(k) - (Vector6() << across, across, -1, 0, 0, 0).finished()).norm() <= 1e-11);
        twice += r == 1 && nodal.column(i, 0) >= 0 ? 1 : 0;
      }
    CHECK(twice == (E::order == 1 ? 9 : E::nodes == 10 ? 25 : 21));
  });
}

TEST_CASE("recovered stress rotates with the body and does not depend on its position", "[post]") {
  testing::Random random(17);
  const Matrix3 r = testing::random_rotation(random);
  for_elements<Tet4, Tet10, Hex8, Hex20>([&]<class E>(std::type_identity<E>) {
    for (const std::array<int, 3>& cells : {std::array{3, 2, 2}, {1, 1, 1}, {3, 1, 1}}) {
      const Mesh<E> mesh = jittered(box_of<E>({1, 0.8, 0.02}, cells), 0.002);
      Mesh<E> rotated = mesh;
      for (Vector3& x : rotated.positions) x = r * x + Vector3(10, -7, 3);
      const VectorX u = nodal_values(mesh, [](const Vector3& x) -> Vector3 {
        return {std::sin(3.0 * x[0]), x[0] * x[1] + 20.0 * x[2] * x[2], std::cos(2.0 * x[1] + x[2])};
      });
      VectorX v(u.size());
      for (Index i = 0; i < mesh.node_count(); ++i) v.segment<3>(3 * i) = r * u.segment<3>(3 * i);
      const NodalStress before = patch_recovery(body_of(mesh, {soft}), u),
                        after = patch_recovery(body_of(rotated, {soft}), v);
      double worst = 0.0;
      for (Index i = 0; i < mesh.node_count(); ++i)
        worst =
            std::max(worst, (r * voigt::stress_tensor(before.at(i)) * r.transpose() - voigt::stress_tensor(after.at(i)))
                                .cwiseAbs()
                                .maxCoeff());
      CHECK(worst <= 1e-9 * before.stress.cwiseAbs().maxCoeff());
    }
  });
}

TEST_CASE("patch recovery: initial strain, orphan nodes, single elements, bad input", "[post]") {
  Vector6 swelling;
  swelling << 0.01, -0.02, 0.03, 0.004, 0.005, -0.006;
  Body<Tet4> body = body_of(box_of<Tet4>({1, 1, 1}, {2, 2, 2}), {soft});
  body.initial_strain.front() = swelling;
  body.mesh.positions.emplace_back(9, 9, 9);  // a node without elements
  VectorX u = VectorX::Zero(3 * body.mesh.node_count());
  const NodalStress constrained = patch_recovery(body, u);
  for (Index i = 0; i + 1 < body.mesh.node_count(); ++i)
    CHECK((constrained.at(i) + soft.elasticity() * swelling).norm() <= 1e-12 * 5e3);
  CHECK(constrained.at(body.mesh.node_count() - 1).isZero(0.0));

  u[0] = std::numeric_limits<double>::quiet_NaN();
  const NodalStress bad = patch_recovery(body, u);
  CHECK(bad.at(0).array().isNaN().any());
  CHECK_THROWS_AS(patch_recovery(body, VectorX(u.head(u.size() - 1))), SetupError);

  Mesh<Tet4> one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  one.elements = {{0, 1, 2, 3}};
  const Body<Tet4> single = body_of(one, {soft});
  const Polynomial linear(1);
  const NodalStress constant = patch_recovery(single, nodal_values(one, linear));
  for (Index i = 0; i < 4; ++i)
    CHECK((constant.at(i) - soft.elasticity() * linear.strain({0, 0, 0})).norm() <= 1e-12 * 5e3);
}
