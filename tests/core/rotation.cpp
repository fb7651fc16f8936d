// The closest rotation of any tensor: regular, flat, inverted, zero.
#include <palpate/core/rotation.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "catch.hpp"

using namespace palpate;

namespace {

Matrix3 closest(const Matrix3& f) {
  return matrix3(closest_rotation(tensor3(f)));
}
double away(const Matrix3& a, const Matrix3& b) {
  return (a - b).norm();
}
bool proper(const Matrix3& r, double tolerance = 1e-14) {
  return away(r.transpose() * r, Matrix3::Identity()) <= tolerance && std::abs(r.determinant() - 1.0) <= tolerance;
}

/// F = R V diag(s) V^T with given stretches, of which only the last may be negative and then is the smallest.
struct Known {
  Matrix3 r, f;
  Known(testing::Random& random, const Vector3& s) : r(testing::random_rotation(random)) {
    const Matrix3 v = testing::random_rotation(random);
    f = r * v * s.asDiagonal() * v.transpose();
  }
};

}  // namespace

TEST_CASE("the closest rotation of a rotation, at all angles and exactly 180 degrees",
          "[core][rotation][extreme][E4]") {
  testing::Random random(7);
  for (int degrees = 0; degrees <= 360; degrees += 5)
    for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, 1, 1),
                                Vector3(1, -2, 3), Vector3(0, 1, -1), Vector3(1e-9, 1, 0)}) {
      const Matrix3 r = Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis.normalized()).toRotationMatrix();
      CHECK(away(closest(r), r) <= 1e-14);
      const Matrix3 stretch = Vector3(1.3, 0.8, 0.6).asDiagonal();
      CHECK(away(closest(r * stretch), r) <= 1e-14);
    }
  for (int i = 0; i < 3; ++i) {  // exactly 180 degrees
    const Matrix3 r = 2.0 * Vector3::Unit(i) * Vector3::Unit(i).transpose() - Matrix3::Identity();
    CHECK(away(closest(r), r) == 0.0);
  }
}

TEST_CASE("the error of the closest rotation is rounding over the sum of the two smallest stretches",
          "[core][rotation]") {
  testing::Random random(8);
  double worst = 0.0;
  for (int k = 0; k < 4000; ++k) {
    Vector3 s = random.vector<3>(0.0, 1.0);
    std::sort(s.data(), s.data() + 3, std::greater<>());
    if (k % 4 == 1) s[2] = -s[2];
    if (k % 4 == 2) s.tail<2>() *= std::pow(10.0, -12.0 * random.uniform());
    if (k % 4 == 3) s = Vector3(1.0, 1.0 - 0.1 * random.uniform(), -1.0 + 0.2 * random.uniform(0.5, 1.0));
    const double gap = (s[1] + s[2]) / s[0], scale = std::pow(10.0, random.uniform(-100.0, 100.0));
    const Known known(random, s);
    const Matrix3 r = closest(scale * known.f);
    CHECK(proper(r));
    worst = std::max(worst, away(r, known.r) * gap);
  }
  CHECK(worst <= 5e-14);
}

TEST_CASE("if several rotations are closest, the result is one of them", "[core][rotation][extreme][E5]") {
  testing::Random random(9);
  const auto optimal = [](const Matrix3& f, double best) {
    const Matrix3 r = closest(f);
    return proper(r) && std::abs((r.transpose() * f).trace() - best) <= 1e-14 * (1.0 + best);
  };
  CHECK(away(closest(Matrix3::Zero()), Matrix3::Identity()) == 0.0);
  for (int k = 0; k < 200; ++k) {
    const double s = random.uniform(0.1, 1.0);
    CHECK(optimal(Known(random, {s, 0.0, 0.0}).f, s));   // a line
    CHECK(optimal(Known(random, {s, s, -s}).f, s));      // a reflection in a point
    CHECK(optimal(Known(random, {1.0, s, -s}).f, 1.0));  // two that cancel
    CHECK(optimal(Known(random, {1.0, s, -s * (1.0 - 1e-9)}).f, 1.0 + 1e-9 * s));
    CHECK(optimal(Known(random, {1.0, s, -s * (1.0 - 1e-3)}).f, 1.0 + 1e-3 * s));
    CHECK(optimal(Known(random, {1.0, 1e-13, 0.0}).f, 1.0 + 1e-13));
    CHECK(optimal(Known(random, {1.0, s, 0.0}).f, 1.0 + s));  // flat
  }
  for (double tiny : {1e-300, 1e-310, 5e-324, 1e300}) CHECK(proper(closest(tiny * Matrix3::Identity())));
}

TEST_CASE("the closest rotation in float and in lanes", "[core][rotation]") {
  testing::Random random(10);
  for (int k = 0; k < 200; ++k) {
    Tensor3<detail::Lanes<double, 8>> wide;
    Tensor3<detail::Lanes<float, 16>> single;
    std::vector<Known> known;
    for (int i = 0; i < 16; ++i) {  // one lane in four is degenerate: the others must not be affected
      known.emplace_back(random, i % 4 == 0 ? Vector3(1.0, 0.0, 0.0) : Vector3(1.2, 0.9, random.uniform(-0.5, 0.8)));
      for (int e = 0; e < 9; ++e) {
        if (i < 8) wide.e[e].set(i, known.back().f.data()[e]);
        single.e[e].set(i, static_cast<float>(known.back().f.data()[e]));
      }
    }
    const auto r = closest_rotation(wide);
    const auto rs = closest_rotation(single);
    for (int i = 0; i < 16; ++i) {
      Matrix3 one, one_single;
      Tensor3<float> alone;
      for (int e = 0; e < 9; ++e) {
        one.data()[e] = r.e[e][i % 8];
        one_single.data()[e] = static_cast<double>(rs.e[e][i]);
        alone.e[e] = single.e[e][i];
      }
      const Matrix3 by_itself = matrix3(closest_rotation(alone)).cast<double>();
      CHECK(proper(one_single, 2e-6));
      CHECK(proper(one));
      if (i % 4 == 0) continue;
      if (i < 8) CHECK(away(one, known[static_cast<std::size_t>(i)].r) <= 1e-14);
      CHECK(away(one_single, known[static_cast<std::size_t>(i)].r) <= 5e-6);
      CHECK(away(one_single, by_itself) <= 5e-6);
    }
  }
}
