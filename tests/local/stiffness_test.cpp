// Element stiffness: closed forms, rigid motions, invariance, and the element of the thesis.
#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/testing/dense.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"
#include "element/thesis_tet4.hpp"
#include "element/user_elements.hpp"
#include "local/closed_form.hpp"

using namespace test;

namespace {

const LinearElastic liver{5e3, 0.45, 1060.0};

template <Element E>
Eigen::Matrix<double, 3 * E::nodes, 1> nodal(const ElementNodes<E>& u) {
  Eigen::Matrix<double, 3 * E::nodes, 1> v;
  for (int a = 0; a < E::nodes; ++a) v.template segment<3>(3 * a) = u.row(a).transpose();
  return v;
}

/// 1/2 u K u of the unit tetrahedron under the displacement gradient `h`, divided by its volume.
double energy_density(const Matrix6& d, const Matrix3& h) {
  const ElementNodes<Tet4> x = Tet4::reference_nodes();
  const auto u = nodal<Tet4>(x * h.transpose());
  return 0.5 * u.dot(detail::element_stiffness<Tet4>(x, d) * u) / Tet4::reference_volume;
}

}  // namespace

TEST_CASE("the stiffness of Tet4 equals the closed form", "[local][closed_form]") {
  testing::Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const LinearElastic m{random.uniform(1.0, 1e6), random.uniform(-0.9, 0.49), 0.0};
    const ElementNodes<Tet4> x = random_tetrahedron(random);
    const auto exact = closed_form_stiffness<long double>(x.cast<long double>(), m);
    const auto k = detail::element_stiffness<Tet4>(x, m.elasticity());
    CHECK(largest(k.cast<long double>() - exact) <= 1e-13 * largest(exact));
  }
}

TEST_CASE("the corner tetrahedron equals the closed form", "[local][closed_form]") {
  // lambda = 2, mu = 1: K_11 = V ((lambda + mu) g g^T + mu g.g I) with g = (-1, -1, -1), g.g = 3, V = 1/6.
  Matrix6 d = Matrix6::Zero();
  d.topLeftCorner<3, 3>().setConstant(2.0);
  d.diagonal() << 4, 4, 4, 1, 1, 1;
  const auto k = detail::element_stiffness<Tet4>(Tet4::reference_nodes(), d);
  const Matrix3 ones = Matrix3::Ones();
  CHECK(largest(k.block<3, 3>(0, 0) - (3.0 * ones + 3.0 * Matrix3::Identity()) / 6.0) < 1e-15);
  CHECK_THAT(k(3, 3), Catch::Matchers::WithinAbs(4.0 / 6.0, 1e-15));  // g = e_x: lambda + 2 mu
  CHECK_THAT(k(4, 4), Catch::Matchers::WithinAbs(1.0 / 6.0, 1e-15));  // mu
  CHECK_THAT(k(3, 7), Catch::Matchers::WithinAbs(2.0 / 6.0, 1e-15));  // g_a = e_x, g_b = e_y: lambda
  CHECK_THAT(k(4, 6), Catch::Matchers::WithinAbs(1.0 / 6.0, 1e-15));  // and mu across
}

TEST_CASE("energies of simple strains", "[local][closed_form]") {
  const Matrix6 d = liver.elasticity();
  const double e = liver.youngs_modulus, nu = liver.poisson_ratio, mu = liver.shear_modulus();
  Matrix3 h = Matrix3::Zero();
  h(1, 1) = 0.02;
  CHECK_THAT(energy_density(d, h), Catch::Matchers::WithinRel(0.5 * (liver.lame_lambda() + 2 * mu) * 4e-4, 1e-12));
  h(0, 0) = h(2, 2) = -nu * 0.02;  // uniaxial stress
  CHECK_THAT(energy_density(d, h), Catch::Matchers::WithinRel(0.5 * e * 4e-4, 1e-12));
  const Matrix3 uniform = 0.01 * Matrix3::Identity();
  CHECK_THAT(energy_density(d, uniform), Catch::Matchers::WithinRel(0.5 * e / (3 * (1 - 2 * nu)) * 9e-4, 1e-12));
}

TEST_CASE("each shear uses its own modulus", "[local][closed_form]") {
  const Matrix6 d = orthotropic();
  const std::array<std::array<int, 2>, 3> planes{{{0, 1}, {0, 2}, {1, 2}}};  // xy, xz, yz
  for (std::size_t i = 0; i < 3; ++i)
    for (bool upper : {false, true}) {
      Matrix3 h = Matrix3::Zero();
      h(planes[i][upper ? 0 : 1], planes[i][upper ? 1 : 0]) = 0.03;
      const Index voigt = 3 + static_cast<Index>(i);
      CHECK_THAT(energy_density(d, h), Catch::Matchers::WithinRel(0.5 * d(voigt, voigt) * 9e-4, 1e-12));
    }
}

TEMPLATE_TEST_CASE("rigid motions are the only motions without energy", "[local][rigid]", Tet4, Tet10, Hex8, Hex20,
                   user::Hex8, user::Tet10, thesis::ThesisTet4) {
  using E = TestType;
  testing::Random random(5);
  for (int trial = 0; trial < 10; ++trial) {
    const ElementNodes<E> x = some_element<E>(random);
    const auto k = detail::element_stiffness<E>(x, orthotropic());
    CHECK(largest(k - k.transpose()) <= 1e-15 * largest(k));
    for (int axis = 0; axis < 3; ++axis) {
      ElementNodes<E> shift = ElementNodes<E>::Zero();
      shift.col(axis).setOnes();
      CHECK(largest(k * nodal<E>(shift)) <= 1e-13 * largest(k));
      ElementNodes<E> spin;
      for (int a = 0; a < E::nodes; ++a)
        spin.row(a) = Vector3::Unit(axis).cross(Vector3(x.row(a).transpose())).transpose();
      CHECK(largest(k * nodal<E>(spin)) <= 1e-13 * largest(k) * largest(spin));
    }
    const VectorX lambda = testing::symmetric_eigenvalues(k);
    CHECK(std::abs(lambda[5]) <= 1e-12 * lambda[3 * E::nodes - 1]);
    CHECK(lambda[6] >= 1e-6 * lambda[3 * E::nodes - 1]);
  }
}

TEMPLATE_TEST_CASE("translated, rotated and scaled elements", "[local][invariance][M1][M2]", Tet4, Tet10, Hex8, Hex20) {
  using E = TestType;
  testing::Random random(7);
  const ElementNodes<E> x = some_element<E>(random);
  const auto k = detail::element_stiffness<E>(x, liver.elasticity());
  SECTION("a translation by a power of two changes no bit of the edges or of K") {
    ElementNodes<E> rounded = (x * 0x1p20).array().round() * 0x1p-20;  // coordinates that survive the shift
    const auto here = detail::element_stiffness<E>(rounded, liver.elasticity());
    rounded.rowwise() += Eigen::RowVector3d(1024.0, -2048.0, 4096.0);
    CHECK(detail::element_stiffness<E>(rounded, liver.elasticity()) == here);
  }
  SECTION("a translation by a thousand element sizes") {
    ElementNodes<E> moved = x;
    moved.rowwise() += Eigen::RowVector3d(1000.1, -1000.2, 999.3);
    CHECK(largest(detail::element_stiffness<E>(moved, liver.elasticity()) - k) <=
          1e-11 * largest(k));  // rounded coordinates
  }
  SECTION("a rotation rotates the blocks") {
    const Matrix3 r = testing::random_rotation(random);
    const auto rotated = detail::element_stiffness<E>(x * r.transpose(), liver.elasticity());
    for (int a = 0; a < E::nodes; ++a)
      for (int b = 0; b < E::nodes; ++b)
        CHECK(largest(rotated.template block<3, 3>(3 * a, 3 * b) -
                      r * k.template block<3, 3>(3 * a, 3 * b) * r.transpose()) <= 1e-13 * largest(k));
  }
  SECTION("twice the size gives twice the stiffness, to the last bit") {
    CHECK(detail::element_stiffness<E>(2.0 * x, liver.elasticity()) == 2.0 * k);
  }
  SECTION("one millionth of the size") {
    CHECK(largest(detail::element_stiffness<E>(1e-6 * x, liver.elasticity()) * 1e6 - k) <= 1e-13 * largest(k));
  }
}

TEST_CASE("a one millimetre tetrahedron one kilometre away keeps orientation and accuracy",
          "[local][extreme][B2][M1]") {
  const ElementNodes<Tet4> small = 0x1p-10 * Tet4::reference_nodes();
  ElementNodes<Tet4> far = small;
  far.rowwise() += Eigen::RowVector3d(1024.0, 1024.0, 1024.0);
  const Vector3 centre = Vector3::Constant(0.25);
  CHECK(detail::point_geometry<Tet4>(far, centre, 1.0 / 6.0).volume ==
        detail::point_geometry<Tet4>(small, centre, 1.0 / 6.0).volume);
  CHECK(detail::element_stiffness<Tet4>(far, liver.elasticity()) ==
        detail::element_stiffness<Tet4>(small, liver.elasticity()));
}

TEST_CASE("gradients map by the inverse transposed Jacobian", "[local][geometry]") {
  testing::Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const ElementNodes<Tet4> x = random_tetrahedron(random);
    const auto g = detail::point_geometry<Tet4>(x, Vector3::Constant(0.25), 1.0 / 6.0);
    Tet4Nodes<double> exact;
    CHECK_THAT(g.volume, Catch::Matchers::WithinRel(closed_form_gradients<double>(x, exact), 1e-13));
    CHECK(largest(g.gradient - exact) <= 1e-13 * largest(exact));
    CHECK(largest(x.transpose() * g.gradient - Matrix3::Identity()) <= 1e-13 * largest(exact));  // sum x_a (x) grad N_a
  }
  ElementNodes<Tet4> inverted = Tet4::reference_nodes();
  inverted.row(1).swap(inverted.row(2));
  CHECK(detail::point_geometry<Tet4>(inverted, Vector3::Zero(), 1.0 / 6.0).volume < 0.0);
}

TEST_CASE("the corrected element of the thesis has the stiffness of Tet4", "[local][thesis]") {
  testing::Random random(13);
  for (int trial = 0; trial < 10; ++trial) {
    const ElementNodes<Tet4> x = random_tetrahedron(random);
    const auto k = detail::element_stiffness<Tet4>(x, orthotropic());
    CHECK(largest(detail::element_stiffness<thesis::ThesisTet4>(x, orthotropic()) - k) <= 1e-13 * largest(k));
  }
}

TEST_CASE("effect of each misprint of the thesis on the stiffness", "[local][thesis]") {
  testing::Random random(17);
  const ElementNodes<Tet4> x = random_tetrahedron(random);
  const Matrix6 d = liver.elasticity();
  const auto k = detail::element_stiffness<Tet4>(x, d);
  ElementNodes<Tet4> shift = ElementNodes<Tet4>::Zero();
  shift.col(0).setOnes();
  SECTION("one-point weight 8 instead of sqrt6 / 4: 16 sqrt6 / 3 times too stiff") {
    const double factor = 16 * thesis::sqrt6 / 3;
    CHECK_THAT(factor, Catch::Matchers::WithinAbs(13.0639, 1e-4));
    CHECK(largest(detail::element_stiffness<thesis::PrintedWeight>(x, d) - factor * k) <= 1e-12 * factor * largest(k));
  }
  SECTION("the wrong gradients: still six zero modes, but a translation strains the element") {
    const detail::ElementStiffness<Tet4> wrong = detail::element_stiffness<thesis::PrintedDerivatives>(x, d);
    CHECK(largest(wrong * nodal<Tet4>(shift)) > 0.1 * largest(wrong));
    ElementNodes<Tet4> moved = x;
    moved.rowwise() += Eigen::RowVector3d(1.0, 1.0, 1.0);
    // The use of edge vectors hides the misprint: K does not depend on the position of the element.
    CHECK(largest(detail::element_stiffness<thesis::PrintedDerivatives>(moved, d) - wrong) <= 1e-12 * largest(wrong));
  }
  SECTION("order 1-2-3-4: a negative volume changes the sign of K") {
    CHECK(detail::point_geometry<thesis::PrintedOrder>(x, Vector3::Zero(), 1.0).volume < 0.0);
    CHECK(largest(detail::element_stiffness<thesis::PrintedOrder>(x, d)) > 0.0);
    CHECK(detail::element_stiffness<thesis::PrintedOrder>(x, d).diagonal().maxCoeff() < 0.0);
  }
}

TEMPLATE_TEST_CASE("the stiffness from Lame's constants equals that from the matrix", "[local]", Tet4, Tet10, Hex8,
                   Hex20, (WithQuadrature<Tet10, TetrahedronRule<3>>)) {  // with a negative weight
  using E = TestType;
  testing::Random random(29);
  for (int trial = 0; trial < 5; ++trial) {
    ElementNodes<E> x = some_element<E>(random);
    const double size = (x.rowwise() - x.row(0)).rowwise().norm().maxCoeff();
    for (int a = 0; a < E::nodes; ++a) x.row(a) += random.vector<3>(-0.02 * size, 0.02 * size).transpose();  // curved
    const LinearElastic m{random.uniform(1.0, 1e6), random.uniform(-0.9, 0.49), 0.0};
    const auto constants = detail::lame_constants(m.elasticity());
    REQUIRE(constants.has_value());
    const auto k = detail::element_stiffness<E>(x, m.elasticity());
    const auto same = detail::element_stiffness<E>(x, *constants);
    CHECK(largest(same - k) <= 1e-13 * largest(k));
    CHECK(same == same.transpose());
  }
}

TEST_CASE("an element inverted at one integration point is detected", "[local][extreme]") {
  ElementNodes<Hex8> x = Hex8::reference_nodes();
  CHECK(detail::is_positively_oriented<Hex8>(x));
  x.row(6) = Eigen::RowVector3d(-0.6, -0.6, -0.6);  // a corner moved through the centre
  CHECK_FALSE(detail::is_positively_oriented<Hex8>(x));
  ElementNodes<Tet10> y = Tet10::reference_nodes();
  y.row(4) = Eigen::RowVector3d(-0.9, 0.0, 0.0);  // a midside node moved beyond the end of its edge
  CHECK_FALSE(detail::is_positively_oriented<Tet10>(y));
}
