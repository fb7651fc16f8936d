// The operators of core/small_matrix.hpp against Eigen's own.
#include <palpate/core/types.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "catch.hpp"

#include <limits>

using namespace palpate;
using testing::Random;

namespace {

// Eigen::Map operands do not use these operators: they give Eigen's expressions.
template <class M>
Eigen::Map<const M> eigen(const M& m) {
  return Eigen::Map<const M>(m.data());
}

template <class A, class B>
double difference(const A& ours, const B& eigens) {
  static_assert(std::derived_from<A, Eigen::PlainObjectBase<A>>, "a value, no expression");
  return (eigen(ours) - eigens).cwiseAbs().maxCoeff();
}

template <class M>
M any(Random& random) {
  M m;
  for (Index i = 0; i < m.size(); ++i) m.data()[i] = random.uniform(-1.0, 1.0);
  return m;
}

template <class M>
void sums_and_multiples(Random& random) {
  const M a = any<M>(random), b = any<M>(random);
  CHECK(difference(M(a + b), eigen(a) + eigen(b)) == 0.0);
  CHECK(difference(a + b, eigen(a) + eigen(b)) == 0.0);
  CHECK(difference(a - b, eigen(a) - eigen(b)) == 0.0);
  CHECK(difference(-a, -eigen(a)) == 0.0);
  CHECK(difference(0.3 * a, 0.3 * eigen(a)) == 0.0);
  CHECK(difference(a * 0.3, eigen(a) * 0.3) == 0.0);
  CHECK(difference(a / 0.3, eigen(a) / 0.3) <= 1e-15);
  CHECK(difference(M(2 * a), 2.0 * eigen(a)) == 0.0);  // an int multiplies as in Eigen
}

}  // namespace

TEST_CASE("sums, differences and multiples are values, equal to Eigen's", "[core]") {
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    sums_and_multiples<Vector3>(random);
    sums_and_multiples<Matrix3>(random);
    sums_and_multiples<Vector6>(random);
    sums_and_multiples<Matrix6>(random);
  }
}

TEST_CASE("products of small matrices and vectors are values, equal to Eigen's", "[core]") {
  Random random(2);
  for (int k = 0; k < 20; ++k) {
    const Matrix3 a = any<Matrix3>(random), b = any<Matrix3>(random);
    const Vector3 v = any<Vector3>(random), w = any<Vector3>(random);
    const Matrix6 d = any<Matrix6>(random);
    const Vector6 e = any<Vector6>(random);
    CHECK(difference(a * v, eigen(a) * eigen(v)) <= 1e-15);
    CHECK(difference(a * b, eigen(a) * eigen(b)) <= 1e-15);
    CHECK(difference(a.transpose() * v, eigen(a).transpose() * eigen(v)) <= 1e-15);
    CHECK(difference(a.transpose() * b, eigen(a).transpose() * eigen(b)) <= 1e-15);
    CHECK(difference(a * b.transpose(), eigen(a) * eigen(b).transpose()) <= 1e-15);
    CHECK(difference(v * w.transpose(), eigen(v) * eigen(w).transpose()) == 0.0);
    CHECK(difference(d * e, eigen(d) * eigen(e)) <= 2e-15);
    CHECK(difference(cross(v, w), eigen(v).cross(eigen(w))) <= 1e-15);
    CHECK(max_abs(v) == eigen(v).cwiseAbs().maxCoeff());
    CHECK(std::abs(determinant(a) - a.determinant()) <= 1e-15);
    CHECK(difference(Matrix3(inverse(a) * a), Matrix3::Identity()) <= 1e-12 / std::abs(determinant(a)));
  }
}

TEST_CASE("a vector may be operand and target simultaneously", "[core]") {
  Matrix3 a;
  a << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  Vector3 v(1, 2, 3);
  const Vector3 once = a * v;
  v = a * v;
  CHECK(v == once);
  Matrix3 b = a;
  b = b * b.transpose();
  CHECK(b == Matrix3(eigen(a) * eigen(a).transpose()));
}

TEST_CASE("a non-finite entry is detected in any place", "[core]") {
  Vector6 v = Vector6::Constant(1e308);
  CHECK(all_finite(v));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity})
    for (int i = 0; i < 6; ++i) {
      Vector6 w = v;
      w[i] = bad;
      CHECK(!all_finite(w));
    }
  CHECK(all_finite(VectorX()));
}

TEST_CASE("entries of nodes in a long vector", "[core]") {
  VectorX all = VectorX::LinSpaced(9, 0.0, 8.0);
  CHECK(node_vector(all, 1) == Vector3(3, 4, 5));
  set_node_vector(all, 2, {1, 1, 1});
  add_node_vector(all, 2, {0, 1, 2});
  CHECK(node_vector(all, 2) == Vector3(1, 2, 3));
  CHECK(node_vector(all, 0) == Vector3(0, 1, 2));
}
