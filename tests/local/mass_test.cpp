// Element mass: closed forms, rigid motions, lumping.
#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/local/mass.hpp>
#include <palpate/testing/dense.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"
#include "local/closed_form.hpp"

using namespace test;
using Catch::Matchers::WithinRel;

namespace {

template <Element E>
double volume_of(const ElementNodes<E>& x) {
  return detail::shape_volumes<E>(x).sum();
}

/// A straight element with displaced nodes, so that its edges are curved.
template <Element E>
ElementNodes<E> bent(testing::Random& random) {
  ElementNodes<E> x = some_element<E>(random);
  for (int a = 0; a < E::nodes; ++a) x.row(a) += 0.02 * random.vector<3>(-1.0, 1.0).transpose();
  return x;
}

}  // namespace

TEST_CASE("the mass of Tet4 equals V/20 (1 + delta)", "[local][mass]") {
  testing::Random random(41);
  for (int trial = 0; trial < 20; ++trial) {
    const ElementNodes<Tet4> x = random_tetrahedron(random);
    Tet4Nodes<double> g;
    const double volume = closed_form_gradients<double>(x, g);
    const Eigen::Matrix4d exact = volume / 20.0 * (Eigen::Matrix4d::Ones() + Eigen::Matrix4d::Identity());
    CHECK(largest(detail::element_mass<Tet4>(x) - exact) <= 1e-14 * volume);
    CHECK(largest(detail::lumped_element_mass<Tet4>(x) - Eigen::Vector4d::Constant(volume / 4.0)) <= 1e-14 * volume);
  }
}

TEST_CASE("the mass of Tet10 equals the exact fractions", "[local][mass]") {
  // int L^a dV = 6 V a! / (|a| + 3)!: corner with corner 6, another corner 1, mid-edges 16 or 32 ... over 420.
  testing::Random random(43);
  const ElementNodes<Tet10> x = some_element<Tet10>(random);
  const double unit = volume_of<Tet10>(x) / 420.0;
  const detail::ElementMass<Tet10> m = detail::element_mass<Tet10>(x);
  const auto is = [&](int a, int b, double times) { return std::abs(m(a, b) - times * unit) <= 1e-12 * unit; };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) CHECK(is(i, j, i == j ? 6.0 : 1.0));
    for (int k = 0; k < 6; ++k) {
      const auto [p, q] = Tet10::edges[static_cast<std::size_t>(k)];
      CHECK(is(i, 4 + k, i == p || i == q ? -4.0 : -6.0));
    }
  }
  for (int k = 0; k < 6; ++k)
    for (int l = 0; l < 6; ++l) {
      const auto [p, q] = Tet10::edges[static_cast<std::size_t>(k)];
      const auto [r, s] = Tet10::edges[static_cast<std::size_t>(l)];
      const int shared = (p == r) + (p == s) + (q == r) + (q == s);
      CHECK(is(4 + k, 4 + l, shared == 2 ? 32.0 : shared == 1 ? 16.0 : 8.0));
    }
}

TEST_CASE("lumped masses are positive where row sums are not", "[local][mass]") {
  testing::Random random(47);
  SECTION("Tet10: 1/36 and 4/27; row sums -1/20 and 1/5") {
    const ElementNodes<Tet10> x = some_element<Tet10>(random);
    const double volume = volume_of<Tet10>(x);
    const auto lumped = detail::lumped_element_mass<Tet10>(x);
    for (int a = 0; a < 10; ++a) {
      CHECK_THAT(lumped[a], WithinRel(volume * (a < 4 ? 1.0 / 36.0 : 4.0 / 27.0), 1e-12));
      CHECK_THAT(detail::element_mass<Tet10>(x).row(a).sum(),
                 WithinRel(volume * (a < 4 ? -1.0 / 20.0 : 1.0 / 5.0), 1e-11));
    }
  }
  SECTION("Hex20: 7/248 and 2/31") {
    // Closed form: the squared shape functions integrate to 28/135 at a corner, 64/135 at an edge midpoint.
    const ElementNodes<Hex20> x = some_element<Hex20>(random);
    const double volume = volume_of<Hex20>(x);
    const auto lumped = detail::lumped_element_mass<Hex20>(x);
    for (int a = 0; a < 20; ++a) CHECK_THAT(lumped[a], WithinRel(volume * (a < 8 ? 7.0 / 248.0 : 2.0 / 31.0), 1e-12));
    CHECK(detail::element_mass<Hex20>(x).row(0).sum() < 0.0);
  }
  SECTION("Hex8: an eighth") {
    const ElementNodes<Hex8> x = some_element<Hex8>(random);
    CHECK(largest(detail::lumped_element_mass<Hex8>(x) / volume_of<Hex8>(x) -
                  Eigen::Matrix<double, 8, 1>::Constant(0.125)) <= 1e-14);
  }
}

TEMPLATE_TEST_CASE("properties of the element mass", "[local][mass]", Tet4, Tet10, Hex8, Hex20) {
  using E = TestType;
  testing::Random random(53);
  for (int trial = 0; trial < 10; ++trial) {
    const ElementNodes<E> x = trial % 2 == 0 ? some_element<E>(random) : bent<E>(random);
    const detail::ElementMass<E> m = detail::element_mass<E>(x);
    const auto lumped = detail::lumped_element_mass<E>(x);
    const auto volumes = detail::shape_volumes<E>(x);
    CHECK(largest(m - m.transpose()) <= 1e-15 * largest(m));
    CHECK(testing::symmetric_eigenvalues(m)[0] > 0.0);  // full rank
    CHECK(largest(m.rowwise().sum() - volumes) <= 1e-14 * volumes.sum());
    CHECK(lumped.minCoeff() > 0.0);
    CHECK_THAT(lumped.sum(), WithinRel(volumes.sum(), 1e-13));
    const ElementNodes<E> far = x.rowwise() + Eigen::RowVector3d(64, -128, 256);
    CHECK(largest(detail::element_mass<E>(far) - m) <= 1e-11 * largest(m));
    CHECK(largest(detail::element_mass<E>(2.0 * x) - 8.0 * m) <= 1e-14 * 8.0 * largest(m));
  }
}
