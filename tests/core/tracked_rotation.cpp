// A rotation tracked from one state to the next is the closest one.
#include <palpate/core/rotation.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>
#include <numbers>

#include "catch.hpp"

using namespace palpate;

namespace {

Quaternion<double> random_quaternion(testing::Random& random) {
  const Eigen::Quaterniond q(testing::random_rotation(random));
  return {q.w(), q.x(), q.y(), q.z()};
}
/// A deformation with these stretches, in random frames.
Matrix3 stretched(testing::Random& random, const Vector3& s) {
  const Matrix3 v = testing::random_rotation(random);
  return testing::random_rotation(random) * v * s.asDiagonal() * v.transpose();
}
double length(const Quaternion<double>& q) {
  return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
}

}  // namespace

TEST_CASE("a tracked rotation is the closest one from any start", "[core][rotation]") {
  testing::Random random(31);
  double worst = 0.0, longest = 0.0;
  for (int k = 0; k < 4000; ++k) {
    Vector3 s = random.vector<3>(0.05, 2.0);
    std::sort(s.data(), s.data() + 3, std::greater<>());
    if (k % 3 == 1) s[2] *= -1.0;  // inverted
    const Tensor3<double> f = tensor3<double>(stretched(random, s));
    Quaternion<double> q = random_quaternion(random);
    const Matrix3 tracked = matrix3(tracked_rotation(f, q)), wanted = matrix3(closest_rotation(f));
    worst = std::max(worst, (tracked - wanted).norm() * (s[1] + s[2]) / s[0]);
    longest = std::max(longest, std::abs(length(q) - 1.0));
  }
  CHECK(worst <= 5e-14);
  CHECK(longest <= 1e-14);
}

TEST_CASE("a rotation of many turns is tracked without drift", "[core][rotation][E4]") {
  const Matrix3 stretch = (Matrix3() << 1.2, 0.1, 0.0, 0.1, 0.8, -0.2, 0.0, -0.2, 1.1).finished();
  const Vector3 axis = Vector3(1.0, -2.0, 0.5).normalized();
  Quaternion<double> q{1.0, 0.0, 0.0, 0.0};
  double worst = 0.0;
  for (int k = 0; k <= 20000; ++k) {  // a little more than three turns
    const Matrix3 r = Eigen::AngleAxisd(1e-3 * k, axis).toRotationMatrix();
    worst = std::max(worst, (matrix3(tracked_rotation(tensor3<double>(Matrix3(r * stretch)), q)) - r).norm());
  }
  CHECK(worst <= 5e-15);
}

TEST_CASE("tracking from the opposite rotation, a saddle point, finds the solution", "[core][rotation][E4]") {
  for (int i = 0; i < 3; ++i) {
    Quaternion<double> q{0.0, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};  // rotated by 180 degrees
    const Matrix3 f = Vector3(1.5, 1.0, 0.5).asDiagonal();
    CHECK((matrix3(tracked_rotation(tensor3<double>(f), q)) - Matrix3::Identity()).norm() <= 1e-15);
  }
}

TEST_CASE("tracking recovers after flat, collapsed and non-finite deformations", "[core][rotation][E5]") {
  testing::Random random(5);
  for (const Vector3& s :
       {Vector3(1, 1, 0), Vector3(1, 0, 0), Vector3(0, 0, 0), Vector3(1, 1, -1), Vector3(1, 1, -0.999)}) {
    Quaternion<double> q = random_quaternion(random);
    const Matrix3 f = stretched(random, s), r = matrix3(tracked_rotation(tensor3<double>(f), q));
    CHECK((r.transpose() * r - Matrix3::Identity()).norm() <= 1e-14);
    CHECK((r.transpose() * f).trace() >= matrix3(closest_rotation(tensor3<double>(f))).cwiseProduct(f).sum() - 1e-14);
  }
  Quaternion<double> q{1.0, 0.0, 0.0, 0.0};
  Tensor3<double> broken = Tensor3<double>::identity();
  broken(1, 2) = std::nan("");
  tracked_rotation(broken, q);
  CHECK((matrix3(tracked_rotation(Tensor3<double>::identity(), q)) - Matrix3::Identity()).norm() <= 1e-15);
}

TEST_CASE("rotations are tracked in single-precision lanes", "[core][rotation]") {
  using Lane = detail::Lanes<float, 16>;
  testing::Random random(17);
  Quaternion<Lane> q{Lane(1.0f), Lane(0.0f), Lane(0.0f), Lane(0.0f)};
  double worst = 0.0;
  for (int k = 0; k < 200; ++k) {
    Tensor3<Lane> f;
    Matrix3 wanted[16];
    for (int lane = 0; lane < 16; ++lane) {
      const double turn = k % 50 == 49 ? 3.0 : 0.01;  // an occasional jump
      const Matrix3 r = Eigen::AngleAxisd(turn * k + lane, Vector3(1, lane, -2).normalized()).toRotationMatrix();
      const Matrix3 one = r * Vector3(1.2, 0.9, k % 7 == lane % 7 ? -0.3 : 0.7).asDiagonal();
      wanted[lane] = matrix3(closest_rotation(tensor3<double>(one)));
      for (int e = 0; e < 9; ++e) f.e[e].set(lane, static_cast<float>(one.data()[e]));
    }
    const Tensor3<Lane> r = tracked_rotation(f, q);
    for (int lane = 0; lane < 16; ++lane)
      for (int e = 0; e < 9; ++e)
        worst = std::max(worst, std::abs(static_cast<double>(r.e[e][lane]) - wanted[lane].data()[e]));
  }
  CHECK(worst <= 2e-6);
}
