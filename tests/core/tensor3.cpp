// Lanes and 3 x 3 tensors against one number at a time and Eigen.
#include <palpate/core/tensor3.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/LU>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("lanes compute the same as single numbers", "[core][lanes]") {
  using Eight = detail::Lanes<double, 8>;
  STATIC_REQUIRE(sizeof(Eight) == 64);
  STATIC_REQUIRE(alignof(Eight) == 64);
  STATIC_REQUIRE(sizeof(detail::Lanes<float, 16>) == 64);
  const double from[] = {9, 0.1, -1.5, 2, -3, 0.25, 1e300, -1e-300, 7}, to[] = {9, 2, 3, -1.5, 0.5, 1, 0.25, 4, 5};
  const Eight a = Eight::load(from + 1), b = Eight::load(to + 1);  // no alignment is required
  double out[8];
  (a + b * 2.0).store(out);
  for (int i = 0; i < 8; ++i) {
    const double x = from[i + 1], y = to[i + 1];
    CHECK(out[i] == x + y * 2.0);
    CHECK((a / b)[i] == x / y);
    CHECK((-a)[i] == -x);
    CHECK((1.0 - a)[i] == 1.0 - x);
    CHECK(min(a, b)[i] == std::min(x, y));
    CHECK(max(a, b)[i] == std::max(x, y));
    CHECK(abs(a)[i] == std::abs(x));
    CHECK(sqrt(abs(a))[i] == std::sqrt(std::abs(x)));
    CHECK(log1p(abs(a))[i] == std::log1p(std::abs(x)));
    CHECK(pow(abs(a), 1.5)[i] == std::pow(std::abs(x), 1.5));
    CHECK(select(a < b, a, b)[i] == (x < y ? x : y));
    CHECK((a <= b)[i] == (x <= y));
    CHECK((!(a >= b))[i] == !(x >= y));
    CHECK(((a > 0.0) & (b > 0.0))[i] == (x > 0.0 && y > 0.0));
    CHECK(((a > 0.0) | (b > 0.0))[i] == (x > 0.0 || y > 0.0));
  }
  CHECK(detail::any(a < 0.0));
  CHECK_FALSE(detail::all(a < 0.0));
  CHECK(detail::all(a <= a));
  CHECK_FALSE(detail::any(Eight(std::numeric_limits<double>::quiet_NaN()) <= a));
}

TEST_CASE("tensors compute the same as Eigen", "[core][tensor]") {
  testing::Random random(3);
  for (int k = 0; k < 10; ++k) {
    const auto any_matrix = [&] { return Matrix3(Eigen::Map<const Matrix3>(random.vector<9>(-1, 1).eval().data())); };
    const Matrix3 a = any_matrix(), b = any_matrix();
    const auto ta = tensor3(a), tb = tensor3(b);
    const auto same = [](const Tensor3<double>& t, const Matrix3& m) { return (matrix3(t) - m).norm() <= 1e-14; };
    CHECK(same(ta, a));
    CHECK(ta(0, 2) == a(0, 2));
    CHECK(same(ta * tb, a * b));
    CHECK(same(transpose_product(ta, tb), a.transpose() * b));
    CHECK(same(2.0 * ta - tb + transpose(ta), 2.0 * a - b + a.transpose()));
    CHECK(same(plus_identity(ta, 3.0), a + 3.0 * Matrix3::Identity()));
    CHECK(same(determinant(ta) * tensor3(Matrix3(a.inverse().transpose())), matrix3(cofactor(ta))));
    CHECK(std::abs(determinant(ta) - a.determinant()) <= 1e-15);
    CHECK(std::abs(determinant(ta, cofactor(ta)) - a.determinant()) <= 1e-15);
    CHECK(std::abs(trace(ta) - a.trace()) <= 1e-15);
    CHECK(std::abs(contract(ta, tb) - a.cwiseProduct(b).sum()) <= 1e-15);
    const Vector3 x = a.col(0), y = b.col(1);
    CHECK(same(outer(column(ta, 0), column(tb, 1)), x * y.transpose()));
    CHECK(std::abs(dot(column(ta, 0), column(tb, 1)) - x.dot(y)) <= 1e-15);
  }
}

TEST_CASE("hyperelastic materials do not satisfy the linear concept, nor linear ones the hyperelastic concept",
          "[concepts][material]") {
  STATIC_REQUIRE(HyperelasticMaterial<NeoHookean>);
  STATIC_REQUIRE_FALSE(LinearMaterial<NeoHookean>);
  STATIC_REQUIRE_FALSE(HyperelasticMaterial<LinearElastic>);
  STATIC_REQUIRE_FALSE(FibreHyperelasticMaterial<NeoHookean>);
}
