// A manufactured solution on uniform and distorted meshes: orders of convergence of displacement and energy, every
// element.
#include "../../benchmarks/accuracy/manufactured.hpp"
#include "../../benchmarks/accuracy/solver.cpp"

#include "catch.hpp"

using namespace palpate;
using accuracy::Manufactured, accuracy::manufactured_errors, accuracy::observed_order, accuracy::refined_cube,
    accuracy::solve_static, accuracy::theoretical_orders;

namespace {

template <Element E>
void check_orders(int coarse) {
  const Manufactured field;
  for (const bool distorted : {false, true}) {
    const auto errors = [&](int n) {
      return manufactured_errors(refined_cube<E>(n, distorted), field, &solve_static<E>);
    };
    const auto before = errors(coarse), after = errors(2 * coarse);
    const double displacement = observed_order(before.displacement, after.displacement, 2.0);
    const double energy = observed_order(before.energy, after.energy, 2.0);
    const auto [expected, expected_energy] = theoretical_orders<E>(distorted);
    INFO((distorted ? "distorted: " : "even: ") << displacement << ' ' << energy);
    CHECK(displacement > expected - 0.25);
    CHECK(displacement < E::order + 1.4);
    CHECK(energy > expected_energy - 0.15);
    CHECK(energy < E::order + 0.4);
    CHECK(after.displacement < 0.02);
  }
}

}  // namespace

TEST_CASE("a manufactured body force is minus the divergence of its stress", "[property][mms]") {
  const Manufactured field;
  const Vector3 x(0.3, 0.7, 0.2);
  Vector3 divergence = Vector3::Zero();
  const double h = 1e-5;
  for (int j = 0; j < 3; ++j) {
    const auto stress = [&](double step) {
      return voigt::stress_tensor(field.material.elasticity() * field.strain(x + step * Vector3::Unit(j)));
    };
    divergence += (stress(h) - stress(-h)).col(j) / (2.0 * h);
    Matrix3 gradient;
    for (int c = 0; c < 3; ++c)
      gradient.col(c) =
          (field.displacement(x + h * Vector3::Unit(c)) - field.displacement(x - h * Vector3::Unit(c))) / (2.0 * h);
    CHECK((voigt::strain_vector(0.5 * (gradient + gradient.transpose())) - field.strain(x)).norm() <= 1e-8);
  }
  CHECK((divergence + field.body_force(x)).norm() <= 1e-8);
}

TEST_CASE("Tet4 converges with its order in displacement and energy", "[property][mms]") {
  check_orders<Tet4>(4);
}
TEST_CASE("Smoothed<Tet4> converges with the order of Tet4 at least", "[property][mms]") {
  check_orders<Smoothed<Tet4>>(4);
}
TEST_CASE("Tet10 converges with its order in displacement and energy", "[property][mms]") {
  check_orders<Tet10>(2);
}
TEST_CASE("Hex8 converges with its order in displacement and energy", "[property][mms]") {
  check_orders<Hex8>(4);
}
TEST_CASE("MeanDilatation<Hex8> converges with its order in displacement and energy", "[property][mms]") {
  check_orders<MeanDilatation<Hex8>>(4);
}
TEST_CASE("Hex20 converges with its order in displacement and energy", "[property][mms]") {
  check_orders<Hex20>(2);
}
