// Principal values and directions.
#include <palpate/core/voigt.hpp>
#include <palpate/post/principal.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/LU>

#include "catch.hpp"

#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

/// Checks descending values, a right-handed orthonormal basis, and the reassembled tensor.
void check(const Matrix3& t, double tolerance = 1e-14) {
  const Principal p = principal(t);
  const double size = t.cwiseAbs().maxCoeff();
  CHECK(p.values[0] >= p.values[1]);
  CHECK(p.values[1] >= p.values[2]);
  CHECK((p.directions.transpose() * p.directions - Matrix3::Identity()).cwiseAbs().maxCoeff() <= 1e-14);
  CHECK_THAT(p.directions.determinant(), WithinRel(1.0, 1e-14));
  const Matrix3 scaled = p.directions * (p.values / (size > 0.0 ? size : 1.0)).asDiagonal() * p.directions.transpose();
  CHECK((size > 0.0 ? Matrix3(scaled - t / size) : scaled).cwiseAbs().maxCoeff() <= tolerance);
}

}  // namespace

TEST_CASE("principal values of known tensors in random frames, including repeated values", "[post]") {
  testing::Random random(101);
  for (const Vector3& values :
       {Vector3(3, 2, -1), Vector3(5, 5, -2), Vector3(4, -1, -1), Vector3(2, 2, 2), Vector3(0, 0, 0),
        Vector3(1, 1e-9, 0), Vector3(1, 1 - 1e-15, 1 - 2e-15), Vector3(7, 0, 0), Vector3(0, 0, -7)})
    for (int i = 0; i < 50; ++i) {
      const Matrix3 r = i == 0 ? Matrix3(Matrix3::Identity()) : testing::random_rotation(random);
      Matrix3 t = r * values.asDiagonal() * r.transpose();
      t = Matrix3(0.5 * (t + t.transpose()));
      check(t);
      CHECK((principal(t).values - values).cwiseAbs().maxCoeff() <= 1e-14 * 7);
    }
}

TEST_CASE("principal values of extreme tensors", "[post]") {
  testing::Random random(103);
  for (double size : {1e-320, 1e-300, 1e-160, 1.0, 1e160, 1e300}) {
    Matrix3 t;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) t(i, j) = t(j, i) = random.uniform(-1.0, 1.0) * size;
    check(t, size < 1e-310 ? 1e-3 : 1e-14);  // denormal numbers have few digits
  }
  Matrix3 graded = Matrix3::Identity();
  graded(0, 1) = graded(1, 0) = 1e-200;
  check(graded);
  graded(1, 2) = graded(2, 1) = 1e-17;
  check(graded);
  for (double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    Matrix3 t = Matrix3::Identity();
    t(0, 2) = t(2, 0) = bad;
    CHECK(principal(t).values.array().isNaN().all());
    CHECK(principal(t).directions.allFinite());
  }
}

TEST_CASE("principal stress and strain use their Voigt conventions", "[post]") {
  const double tau = 3.0;
  const Principal shear = principal_stress(tau * Vector6::Unit(voigt::xz));
  CHECK((shear.values - Vector3(tau, 0.0, -tau)).norm() <= 1e-14);
  CHECK(std::abs(shear.directions.col(0).dot(Vector3(1, 0, 1).normalized())) >= 1.0 - 1e-14);
  const Principal strain = principal_strain(0.02 * Vector6::Unit(voigt::yz));  // gamma = 2 epsilon
  CHECK((strain.values - Vector3(0.01, 0.0, -0.01)).norm() <= 1e-16);
  Vector6 s;
  s << 4, -2, 1, 3, -1, 2;
  const Vector3 p = principal_stress(s).values;
  CHECK_THAT(std::sqrt(0.5 * (std::pow(p[0] - p[1], 2) + std::pow(p[1] - p[2], 2) + std::pow(p[2] - p[0], 2))),
             WithinRel(voigt::von_mises(s), 1e-14));
}
