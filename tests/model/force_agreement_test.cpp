#include <palpate/model/moving/detail/force_agreement.hpp>

#include <array>

#include "catch.hpp"

using namespace palpate;

namespace {

std::array<VertexForce, 2> two_forces(double first, double second) {
  return {VertexForce{0, ModelVector(Vector3(0.0, 0.0, first))},
          VertexForce{2, ModelVector(Vector3(0.0, 0.0, second))}};
}

}  // namespace

TEST_CASE("forces that go up and down ask for stiffer springs", "[model][force_agreement]") {
  detail::ForceAgreement agreement(3);
  for (int k = 0; k < 20; ++k) agreement.add(two_forces(1.0, k % 2 == 0 ? 1.0 : 1.01));
  CHECK(agreement.spring_stiffness() == 7.0);
  for (int k = 0; k < 100; ++k) agreement.add(two_forces(1.0, 1.0));
  CHECK(agreement.spring_stiffness() == 3.0);
}

TEST_CASE("forces that grow ask for no stiffer springs", "[model][force_agreement]") {
  detail::ForceAgreement agreement(3);
  for (int k = 1; k < 50; ++k) agreement.add(two_forces(0.1 * k, 0.05 * k * k));
  CHECK(agreement.spring_stiffness() == 3.0);
}

TEST_CASE("what a step found otherwise stays with friction until the forces change", "[model][force_agreement]") {
  const bool has_friction = GENERATE(false, true);
  detail::ForceAgreement agreement(3);
  agreement.add(two_forces(1.0, 1.0));
  agreement.compare(0.01, 1.0, has_friction);
  CHECK(agreement.is_poor());
  agreement.add(two_forces(1.0, 1.0));
  agreement.compare(1e-6, 1.0, has_friction);
  CHECK(agreement.is_poor() == has_friction);
  agreement.add(two_forces(2.0, 0.0));
  CHECK_FALSE(agreement.is_poor());
  agreement.compare(0.5, 1.0, has_friction);
  agreement.add({});
  CHECK_FALSE(agreement.is_poor());
}
