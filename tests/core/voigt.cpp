#include <palpate/core/voigt.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("Voigt order is xx yy zz xy xz yz", "[core][voigt]") {
  Matrix3 t;
  t << 1, 4, 5,  //
      4, 2, 6,   //
      5, 6, 3;
  Vector6 expected;
  expected << 1, 2, 3, 4, 5, 6;
  CHECK(voigt::stress_vector(t) == expected);
  CHECK(voigt::stress_tensor(expected) == t);
  CHECK(expected[voigt::xy] == t(0, 1));
  CHECK(expected[voigt::xz] == t(0, 2));
  CHECK(expected[voigt::yz] == t(1, 2));
}

TEST_CASE("strain vectors contain engineering shear", "[core][voigt]") {
  Matrix3 e;
  e << 1, 4, 5,  //
      4, 2, 6,   //
      5, 6, 3;
  Vector6 expected;
  expected << 1, 2, 3, 8, 10, 12;
  CHECK(voigt::strain_vector(e) == expected);
}

TEST_CASE("stress times strain is the same work in both notations", "[core][voigt]") {
  testing::Random random(1);
  for (int k = 0; k < 20; ++k) {
    const Vector6 s = random.vector<6>(-1.0, 1.0);
    const Matrix3 e = voigt::stress_tensor(random.vector<6>(-1.0, 1.0));
    CHECK_THAT(s.dot(voigt::strain_vector(e)), WithinAbs(voigt::stress_tensor(s).cwiseProduct(e).sum(), 1e-14));
  }
}

TEST_CASE("von Mises stress", "[core][voigt]") {
  const auto at = [](int i, double value) {
    Vector6 s = Vector6::Zero();
    s[i] = value;
    return s;
  };
  CHECK(voigt::von_mises(Vector6::Zero()) == 0.0);
  for (int i : {voigt::xx, voigt::yy, voigt::zz}) CHECK_THAT(voigt::von_mises(at(i, -7e3)), WithinRel(7e3, 1e-14));
  for (int i : {voigt::xy, voigt::xz, voigt::yz})
    CHECK_THAT(voigt::von_mises(at(i, -7e3)), WithinRel(7e3 * std::sqrt(3.0), 1e-14));

  SECTION("pressure has no influence") {
    const Vector6 pressure = at(0, 5.0) + at(1, 5.0) + at(2, 5.0);
    CHECK(voigt::von_mises(pressure) == 0.0);
    CHECK_THAT(voigt::von_mises(pressure + at(voigt::xz, 2.0)), WithinRel(2.0 * std::sqrt(3.0), 1e-14));
  }
  SECTION("it does not depend on the axes") {
    testing::Random random(2);
    for (int k = 0; k < 20; ++k) {
      const Vector6 s = random.vector<6>(-1.0, 1.0);
      const Matrix3 r = testing::random_rotation(random);
      const Vector6 rotated = voigt::stress_vector(r * voigt::stress_tensor(s) * r.transpose());
      CHECK_THAT(voigt::von_mises(rotated), WithinRel(voigt::von_mises(s), 1e-13));
    }
  }
}
