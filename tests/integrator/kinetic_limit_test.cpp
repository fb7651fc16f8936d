// Limited kinetic energy of free and constrained bodies.
#include <palpate/integrator/detail/kinetic_limit.hpp>
#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

VectorX random_vector(std::uint64_t seed, double lowest, double highest) {
  testing::Random random(seed);
  VectorX v(30);
  for (double& x : v) x = random.uniform(lowest, highest);
  return v;
}
Vector3 momentum(const VectorX& mass, const VectorX& v) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < v.size() / 3; ++i) sum += mass[3 * i] * node_vector(v, i);
  return sum;
}

}  // namespace

TEST_CASE("The kinetic energy of a body is limited, and a free body keeps its momentum") {
  const VectorX mass = detail::mass_of_dofs(random_vector(1, 0.5, 2.0).head(10)), start = random_vector(2, -1.0, 2.0);
  const auto kinetic = [&](const VectorX& v) { return 0.5 * v.dot(mass.cwiseProduct(v)); };
  const double before = kinetic(start);
  VectorX v = start;

  detail::limit_kinetic_energy(1.1 * before, mass, true, v);
  CHECK(v == start);
  detail::limit_kinetic_energy(0.9 * before, mass, true, v);
  CHECK(std::abs(kinetic(v) - 0.9 * before) < 1e-12 * before);
  CHECK((momentum(mass, v) - momentum(mass, start)).norm() < 1e-12 * momentum(mass, start).norm());

  detail::limit_kinetic_energy(0.0, mass, true, v);  // less than the energy of the mean velocity: the rest is taken
  CHECK((momentum(mass, v) - momentum(mass, start)).norm() < 1e-12 * momentum(mass, start).norm());
  for (Index i = 1; i < 10; ++i) CHECK((node_vector(v, i) - node_vector(v, 0)).norm() < 1e-12);

  v = start;
  detail::limit_kinetic_energy(0.25 * before, mass, false, v);
  CHECK((v - 0.5 * start).norm() < 1e-12 * start.norm());
}
