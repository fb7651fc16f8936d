// The error estimate against the true error.
#include <palpate/post/error_estimate.hpp>

#include <Eigen/LU>

#include "../../benchmarks/accuracy/lame_sphere.hpp"

#include "catch.hpp"

using namespace palpate;
using accuracy::body_of, accuracy::box_of;

namespace {

using Cured = MeanDilatation<Hex8>;
constexpr LinearElastic tissue{.youngs_modulus = 5e3, .poisson_ratio = 0.3};

/// Energy norm of the difference between the computed and the exact stress.
template <Element E, class Stress>
double true_error(const Body<E>& body, const VectorX& u, Stress exact) {
  const Matrix6 compliance = body.elasticity.front().inverse();
  const detail::ElementStress<E> state(body, u);
  double square = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e)
    for (const detail::StressPoint& point : state.template points<typename E::MassQuadrature>(e)) {
      const Vector6 missed = exact(point.position) - point.stress;
      square += point.volume * missed.dot(compliance * missed);
    }
  return std::sqrt(square);
}

/// Error estimated / error on an eighth of a hollow sphere of n cells.
template <Element E>
double effectivity(int n, double nu) {
  accuracy::LameSphere sphere;
  sphere.material.poisson_ratio = nu;
  const Body<E> body = body_of(accuracy::sphere_octant<E>(1.0, 2.0, n, n), {sphere.material});
  const VectorX u = accuracy::solve_static(body, sphere.scene()).displacement;
  const ErrorEstimate estimate = estimate_error(body, u);
  CHECK(estimate.elements.allFinite());
  CHECK_THAT(estimate.elements.norm(), Catch::Matchers::WithinRel(estimate.error, 1e-12));
  CHECK_THAT(estimate.energy_norm, Catch::Matchers::WithinRel(std::sqrt(2.0 * strain_energy(body, u)), 5e-3));
  return estimate.error / true_error(body, u, [&](const Vector3& x) { return sphere.stress(x); });
}

template <Element E>
void check_effectivity(int n, double most_coarse = 1.7, double most_fine = 1.16) {
  for (double nu : {0.3, 0.45}) {
    const double coarse = effectivity<E>(n, nu), fine = effectivity<E>(2 * n, nu);
    INFO("nodes " << E::nodes << ", nu " << nu << ": " << coarse << " then " << fine);
    CHECK(coarse > 0.75);
    CHECK(coarse < most_coarse);
    CHECK(fine > 0.84);
    CHECK(fine < most_fine);
    CHECK(std::abs(std::log(fine)) < std::abs(std::log(coarse)) + 0.05);
  }
}

}  // namespace

TEST_CASE("the estimate tends to the error on Lame's sphere", "[post]") {
  SECTION("Tet4") {
    check_effectivity<Tet4>(4);
  }
  SECTION("Hex8") {
    check_effectivity<Hex8>(4);
  }
  SECTION("MeanDilatation<Hex8>") {
    check_effectivity<Cured>(4);
  }
  SECTION("Tet10") {
    check_effectivity<Tet10>(2);
  }
  SECTION("Hex20") {
    check_effectivity<Hex20>(2, 2.5, 1.8);
  }  // wide patches at surfaces: slow convergence from above
}

TEST_CASE("no error when the element represents the solution, and none without load", "[post]") {
  const Body<Tet4> body = body_of(box_of<Tet4>({1, 1, 1}, {3, 3, 3}), {tissue});
  VectorX u(3 * body.mesh.node_count());
  for (Index i = 0; i < body.mesh.node_count(); ++i)
    u.segment<3>(3 * i) = Vector3(0.1, 0.02, -0.03).cwiseProduct(body.mesh.position(i));
  CHECK(estimate_error(body, u).relative() <= 1e-13);
  const ErrorEstimate none = estimate_error(body, VectorX(VectorX::Zero(u.size())));
  CHECK(none.relative() == 0.0);
  CHECK((none.size_ratio(0.05).array() == 8.0).all());
}

TEST_CASE("the estimate finds where the mesh is too coarse, and the suggested sizes reach the target", "[post]") {
  // A beam clamped at one end: the error is concentrated there.
  const Scene scene = Scene().fix("x0").traction("x1", {0.0, 0.0, -1e-3});
  const Body<Hex8> body = body_of(box_of<Hex8>({4, 1, 1}, {8, 4, 4}), {tissue});
  const ErrorEstimate coarse = estimate_error(body, accuracy::solve_static(body, scene).displacement);
  Index worst = 0;
  coarse.elements.maxCoeff(&worst);
  CHECK(element_nodes<Hex8>(body.mesh, worst).col(0).mean() < 0.5);
  const VectorX ratio = coarse.size_ratio(0.5 * coarse.relative());
  Index smallest = 0;
  ratio.minCoeff(&smallest);
  CHECK(smallest == worst);

  // For a smooth solution, elements of half the size have half of the error.
  const accuracy::LameSphere sphere;
  const auto estimate = [&](int n) {
    const Body<Hex8> wall = body_of(accuracy::sphere_octant<Hex8>(1.0, 2.0, n, n), {sphere.material});
    return estimate_error(wall, accuracy::solve_static(wall, sphere.scene()).displacement);
  };
  const ErrorEstimate before = estimate(4);
  const double target = estimate(8).relative();
  const VectorX sizes = before.size_ratio(target);
  const double mean = std::exp(sizes.array().log().mean());
  INFO(before.relative() << ' ' << target << ' ' << mean);
  CHECK(mean > 0.4);
  CHECK(mean < 0.75);
}

TEST_CASE("the estimate does not depend on units, position and orientation", "[post]") {
  testing::Random random(3);
  const Matrix3 r = testing::random_rotation(random);
  const Mesh<Tet10> mesh = accuracy::jittered(box_of<Tet10>({1, 1, 1}, {2, 2, 2}), 0.05);
  Mesh<Tet10> moved = mesh;
  VectorX u(3 * mesh.node_count()), v(u.size());
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vector3& x = mesh.position(i);
    u.segment<3>(3 * i) = Vector3(std::sin(2.0 * x[0]), x[1] * x[2] * x[0], std::cos(x[2]));
    v.segment<3>(3 * i) = 1e-3 * r * u.segment<3>(3 * i);
    moved.positions[static_cast<std::size_t>(i)] = 1e-3 * (r * x + Vector3(3, 4, 5));
  }
  const ErrorEstimate here = estimate_error(body_of(mesh, {tissue}), u),
                      there = estimate_error(body_of(moved, {tissue}), v);
  CHECK_THAT(there.relative(), Catch::Matchers::WithinRel(here.relative(), 1e-9));
  CHECK((here.size_ratio(0.01) - there.size_ratio(0.01)).cwiseAbs().maxCoeff() <= 1e-8);
}

TEST_CASE("the estimate of a displacement that is not finite is not finite; bad arguments are refused", "[post]") {
  const Body<Tet4> body = body_of(box_of<Tet4>({1, 1, 1}, {3, 3, 3}), {tissue});
  VectorX u = VectorX::Zero(3 * body.mesh.node_count());
  u[1] = std::numeric_limits<double>::quiet_NaN();
  const ErrorEstimate bad = estimate_error(body, u);
  CHECK(std::isnan(bad.error));
  CHECK(std::isnan(bad.elements[0]));
  CHECK(bad.size_ratio(0.1).array().isNaN().any());
  for (double target : {0.0, -1.0, 1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS(bad.size_ratio(target), SetupError);
  CHECK_THROWS_AS(bad.size_ratio(0.1, 0.5), SetupError);
  CHECK_THROWS_AS(estimate_error(body, VectorX()), SetupError);
  CHECK_THROWS_AS(estimate_error(body, u, NodalStress{}), SetupError);
}
