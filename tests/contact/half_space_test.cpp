// Fields and compliance of an elastic half-space.
#include <palpate/contact/detail/half_space.hpp>
#include <palpate/contact/detail/half_space_field.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double pi = std::numbers::pi;

/// Largest difference of two matrices, relative to the largest entry of the second.
double difference(const Matrix3& a, const Matrix3& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

detail::HalfSpacePoint point(const Vector3& x, const Vector3& normal, double mu, double nu) {
  return {x, normal, detail::HalfSpacePoint::root_of(mu), nu, 1.0};
}

/// Displacement per force in a half-space whose outward normal is z, component by component as Johnson (1985) has them
/// in 3.2 and 3.6, where z is the depth.
Matrix3 johnson(const Vector3& d, double mu, double nu) {
  const double x = d[0], y = d[1], z = -d[2], r = d.norm(), k = 1.0 - 2.0 * nu, c = 1.0 / (4.0 * pi * mu);
  const auto along = [&](double a) {
    return 1 / r + a * a / std::pow(r, 3) + k * (1 / (r + z) - a * a / (r * std::pow(r + z, 2)));
  };
  const double shear = x * y / std::pow(r, 3) - k * x * y / (r * std::pow(r + z, 2));
  const double sink = z / std::pow(r, 3) + k / (r * (r + z));    // depth per tangential force
  const double spread = z / std::pow(r, 3) - k / (r * (r + z));  // outwards per force into the body
  Matrix3 u;
  u << along(x), shear, -x * spread, shear, along(y), -y * spread, -x * sink, -y * sink,
      z * z / std::pow(r, 3) + 2 * (1 - nu) / r;
  return c * u;
}

/// A random rotation and a point at most 25 degrees above the plane of its normal.
struct Place {
  Matrix3 axes;
  Vector3 normal, offset;
  explicit Place(testing::Random& random) : axes(testing::random_rotation(random)), normal(axes.col(2)) {
    do offset = random.vector<3>(-1.0, 1.0);
    while (offset.norm() < 0.3 || offset[2] > 0.4 * offset.norm());
    offset = axes * offset;
  }
};

}  // namespace

TEST_CASE("the fields of a half-space are those of Boussinesq and Cerruti", "[contact][half_space]") {
  const double nu = GENERATE(0.0, 0.3, 0.45, 0.4999, 0.5), mu = 700.0;
  testing::Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Place at(random);
    const detail::HalfSpaceField field(mu, nu, at.normal);
    const Matrix3 expected = at.axes * johnson(at.axes.transpose() * at.offset, mu, nu) * at.axes.transpose();
    CHECK(difference(field.displacement(at.offset), expected) <= 1e-13);
  }
  // Under a pull of 1 N the stress is 3 / (2 pi z^2) (Johnson 3.20a), under a tangential force none.
  const detail::HalfSpaceField field(mu, nu, Vector3::UnitZ());
  const Matrix3 under = field.traction(Vector3(0.0, 0.0, -2.0), Vector3::UnitZ());
  CHECK_THAT(under(2, 2), WithinRel(3.0 / (2.0 * pi * 4.0), 1e-13));
  CHECK_THAT(under(2, 0), WithinAbs(0.0, 1e-15));
}

TEST_CASE("the fields of a half-space are in equilibrium", "[contact][half_space]") {
  const double nu = GENERATE(0.0, 0.3, 0.4999, 0.5), step = 1e-4;
  testing::Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Place at(random);
    const detail::HalfSpaceField field(700.0, nu, at.normal);
    const auto gradient = field.gradient(at.offset);
    Matrix3 force = Matrix3::Zero(), largest = Matrix3::Zero();
    for (int m = 0; m < 3; ++m) {
      const Vector3 h = step * Vector3::Unit(m);
      const Matrix3 by_differences =
          (field.displacement(at.offset + h) - field.displacement(at.offset - h)) / (2.0 * step);
      CHECK(difference(gradient[static_cast<std::size_t>(m)], by_differences) <= 1e-5);
      const Matrix3 before = field.traction(at.offset - h, Vector3::Unit(m));
      force += (field.traction(at.offset + h, Vector3::Unit(m)) - before) / (2.0 * step);
      largest = largest.cwiseMax(before.cwiseAbs());
    }
    Vector3 mean = Vector3::Zero();
    for (int m = 0; m < 3; ++m) mean += field.traction(at.offset, Vector3::Unit(m)).row(m).transpose() / 3.0;
    CHECK((field.mean_stress(at.offset) - mean).norm() <= 1e-12 * largest.maxCoeff());
    CHECK(force.cwiseAbs().maxCoeff() <= 1e-4 * largest.maxCoeff());
    const Vector3 on_plane = at.offset - at.normal.dot(at.offset) * at.normal;
    CHECK(field.traction(on_plane, at.normal).cwiseAbs().maxCoeff() <= 1e-11 / on_plane.squaredNorm());
  }
}

TEST_CASE("the stress of a half-space carries the force", "[contact][half_space]") {
  const double nu = GENERATE(0.0, 0.3, 0.4999, 0.5);
  const detail::HalfSpaceField field(700.0, nu, Vector3::UnitZ());
  Matrix3 total = Matrix3::Zero();  // of the tractions on half a sphere of radius 1
  constexpr int around = 12;
  for (const auto& p : GaussLegendre<5>::points) {
    const double z = 0.5 * (p.xi[0] + 1.0), flat = std::sqrt(1.0 - z * z);
    for (int i = 0; i < around; ++i) {
      const double angle = 2.0 * pi * i / around;
      const Vector3 x(flat * std::cos(angle), flat * std::sin(angle), -z);
      total += pi / around * p.weight * field.traction(x, x);
    }
  }
  CHECK(difference(total, -Matrix3::Identity()) <= 1e-4);
}

TEST_CASE("the compliance of a half-space is the surface value of its fields", "[contact][half_space]") {
  const double nu = GENERATE(0.0, 0.3, 0.4999, 0.5), mu = 1700.0;
  testing::Random random(7);
  for (int i = 0; i < 20; ++i) {
    const Place at(random);
    const Vector3 flat = at.offset - at.normal.dot(at.offset) * at.normal, origin = random.vector<3>(-1.0, 1.0);
    const detail::HalfSpacePoint q = point(origin, at.normal, mu, nu), p = point(origin + flat, at.normal, mu, nu);
    CHECK(difference(detail::half_space_compliance(p, q),
                     detail::HalfSpaceField(mu, nu, at.normal).displacement(flat)) <= 1e-12);
  }
}

TEST_CASE("the compliance of a half-space is symmetric between any two points", "[contact][half_space]") {
  testing::Random random(9);
  for (int i = 0; i < 20; ++i) {
    const auto any = [&] {
      return point(random.vector<3>(-1.0, 1.0), random.vector<3>(-1.0, 1.0).normalized(), random.uniform(1.0, 100.0),
                   random.uniform(0.0, 0.5));
    };
    const detail::HalfSpacePoint p = any(), q = any();
    CHECK(
        (detail::half_space_compliance(p, q) - detail::half_space_compliance(q, p).transpose()).cwiseAbs().maxCoeff() <=
        1e-15 * detail::half_space_compliance(p, q).cwiseAbs().maxCoeff());
  }
}

TEST_CASE("the self compliance is that of a disc under uniform traction", "[contact][half_space]") {
  const double nu = GENERATE(0.0, 0.3, 0.4999, 0.5), radius = 0.02;
  testing::Random random(11);
  const Vector3 normal = random.vector<3>(-1.0, 1.0).normalized();
  const detail::HalfSpacePoint middle = point(Vector3(1.0, 2.0, 3.0), normal, 1700.0, nu);
  const Vector3 a = normal.unitOrthogonal(), b = normal.cross(a);
  Matrix3 mean = Matrix3::Zero();  // r G does not depend on r
  for (int i = 0; i < 8; ++i) {
    const double angle = 2.0 * pi * i / 8;
    const Vector3 rim = middle.position + radius * (std::cos(angle) * a + std::sin(angle) * b);
    mean += 2.0 / 8 * detail::half_space_compliance(middle, point(rim, normal, 1700.0, nu));
  }
  CHECK(difference(detail::half_space_self_compliance(middle, pi * std::pow(1.06 * radius, 2)), mean) <= 1e-12);
}

TEST_CASE("the support of the compliance of a half-space ends smoothly", "[contact][half_space]") {
  const auto support = [](double r, double angle = 0.0) {
    detail::HalfSpacePoint p = point(Vector3::Zero(), Vector3::UnitZ(), 1.0, 0.3), q = p;
    q.position[0] = r;
    q.normal = Vector3(std::sin(angle), 0.0, std::cos(angle));
    p.length = 0.5;
    q.length = 1.5;
    CHECK(detail::half_space_support(p, q) == detail::half_space_support(q, p));
    return detail::half_space_support(p, q);
  };
  CHECK(support(2.0) == 1.0);
  CHECK_THAT(support(3.0), WithinRel(0.5, 1e-15));
  CHECK(support(4.0) == 0.0);
  CHECK(support(1.0, 0.49 * pi) == 1.0);
  CHECK(support(1.0, pi) == 0.0);
  const double h = 1e-4;
  for (const double r : {2.0, 4.0}) {
    CHECK_THAT((support(r + h) - support(r - h)) / h, WithinAbs(0.0, 1e-6));
    CHECK_THAT((support(r + h) - 2.0 * support(r) + support(r - h)) / (h * h), WithinAbs(0.0, 1e-2));
  }
  for (double r = 2.0; r < 4.0; r += 0.01) CHECK(support(r + 0.01) <= support(r));
}

TEST_CASE("the two sides of a slit have no compliance of a half-space between them", "[contact][half_space]") {
  const detail::HalfSpacePoint up = point(Vector3::Zero(), Vector3::UnitZ(), 1.0, 0.3);
  const detail::HalfSpacePoint down = point(Vector3(0.0, 0.0, 1e-12), -Vector3::UnitZ(), 1.0, 0.3);
  CHECK(detail::supported_compliance(up, down) == Matrix3::Zero());
  CHECK(detail::supported_compliance(up, up) == Matrix3::Zero());  // its own is half_space_self_compliance
}

TEST_CASE("the displacement by many loads is the sum of the supported compliance times the forces",
          "[contact][half_space]") {
  testing::Random random(5);
  const auto made = [&] {
    const Vector3 normal = random.vector<3>(-1.0, 1.0) + Vector3(0.0, 0.0, 1.5);
    detail::HalfSpacePoint p = point(random.vector<3>(-5.0, 5.0), normal.normalized(), 1e3, random.uniform() * 0.5);
    p.body = random.uniform() < 0.2 ? 1 : 0;
    return p;
  };
  int zero = 0;
  for (int count = 0; count <= 9; ++count) {
    detail::HalfSpaceLoads loads(9);
    for (int i = 0; i < 9; ++i) loads.set(i, made(), Vector3::Ones());  // of a larger count before
    std::vector<detail::HalfSpacePoint> points;
    std::vector<Vector3> forces;
    for (int i = 0; i < count; ++i) {
      points.push_back(made());
      forces.push_back(random.vector<3>(-1.0, 1.0));
      loads.set(i, points.back(), forces.back());
    }
    for (int k = 0; k < 200; ++k) {
      const bool is_loaded = k % 10 == 0 && count > 0;
      const detail::HalfSpacePoint p = is_loaded ? points[static_cast<std::size_t>(k) % points.size()] : made();
      Vector3 expected(1e-3, 2e-3, 3e-3), u = expected;
      double scale = 1e-3;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].body != p.body) continue;
        const Vector3 part = detail::supported_compliance(p, points[i]) * forces[i];
        expected += part;
        scale += part.norm();
        zero += part.isZero(0.0);
      }
      loads.add_displacement(count, p, u);
      CHECK((u - expected).norm() <= 1e-13 * scale);
    }
  }
  CHECK(zero > 50);
}
