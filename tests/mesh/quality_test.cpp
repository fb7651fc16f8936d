#include <Eigen/Geometry>

#include "element/user_elements.hpp"
#include "mesh_helpers.hpp"

using namespace test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

ElementNodes<Tet4> regular_tetrahedron() {
  ElementNodes<Tet4> x;
  x << 1, 1, 1, -1, 1, -1, 1, -1, -1, -1, -1, 1;
  return x;
}

/// 12 (3V)^(2/3) / sum of squared edges.
double textbook_quality(const ElementNodes<Tet4>& x) {
  const Vector3 a = x.row(1) - x.row(0), b = x.row(2) - x.row(0), c = x.row(3) - x.row(0);
  const double volume = a.cross(b).dot(c) / 6.0;
  double squares = 0.0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) squares += (x.row(i) - x.row(j)).squaredNorm();
  return 12.0 * std::pow(3.0 * volume, 2.0 / 3.0) / squares;
}

}  // namespace

TEST_CASE("the regular tetrahedron has quality one", "[mesh][quality]") {
  const ElementShape s = element_shape<Tet4>(regular_tetrahedron());
  CHECK_THAT(s.quality, WithinAbs(1.0, 1e-14));
  CHECK_THAT(s.volume, WithinRel(8.0 / 3.0, 1e-14));
  CHECK_THAT(s.longest_edge, WithinRel(std::sqrt(8.0), 1e-15));
  CHECK_THAT(s.relative_volume, WithinRel(std::sqrt(2.0) / 12.0, 1e-14));
}

TEST_CASE("Tet4 quality is the textbook mean ratio", "[mesh][quality]") {
  std::srand(7);
  for (int trial = 0; trial < 200; ++trial) {
    ElementNodes<Tet4> x = regular_tetrahedron() + 0.8 * ElementNodes<Tet4>::Random();
    const ElementShape s = element_shape<Tet4>(x);
    if (s.volume <= 0.0) {
      CHECK(s.quality == 0.0);
      continue;
    }
    CHECK_THAT(s.quality, WithinRel(textbook_quality(x), 1e-12));
    CHECK(s.quality <= 1.0 + 1e-14);
    CHECK_THAT(s.relative_volume, WithinRel(s.volume / std::pow(s.longest_edge, 3), 1e-12));
  }
}

TEST_CASE("quality does not depend on scale, position, rotation or node order", "[mesh][quality][extreme][B1][B2]") {
  ElementNodes<Tet4> x = regular_tetrahedron();
  x.row(2) << 0.3, -2.0, -0.7;
  const ElementShape reference = element_shape<Tet4>(x);
  for (double scale : {1e-90, 1e-6, 1e-3, 1.0, 1e3, 1e90}) {
    const ElementShape s = element_shape<Tet4>(ElementNodes<Tet4>(scale * x));
    CHECK_THAT(s.quality, WithinRel(reference.quality, 1e-12));
    CHECK_THAT(s.relative_volume, WithinRel(reference.relative_volume, 1e-12));
  }
  const ElementNodes<Tet4> far = x.rowwise() + Eigen::RowVector3d(3e6, -2e6, 1e6);
  CHECK_THAT(element_shape<Tet4>(far).quality, WithinRel(reference.quality, 1e-8));
  const Matrix3 turn = Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  CHECK_THAT(element_shape<Tet4>(ElementNodes<Tet4>(x * turn)).quality, WithinRel(reference.quality, 1e-12));
  ElementNodes<Tet4> even = x;  // a cyclic permutation keeps the orientation
  even.row(0).swap(even.row(1));
  even.row(1).swap(even.row(2));
  CHECK_THAT(element_shape<Tet4>(even).quality, WithinRel(reference.quality, 1e-12));
}

TEST_CASE("sliver quality falls with height to the power two thirds", "[mesh][quality][extreme][B5]") {
  double before = 0.0;
  for (double height : {1e-3, 1e-6, 1e-9}) {
    ElementNodes<Tet4> x;
    x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.3, 0.3, height;
    const double quality = element_shape<Tet4>(x).quality;
    CHECK_THAT(quality, WithinRel(textbook_quality(x), 1e-9));
    if (before > 0.0) CHECK_THAT(quality / before, WithinRel(1e-2, 0.01));
    before = quality;
  }
}

TEST_CASE("elements of size zero have no shape", "[mesh][quality][extreme][B3]") {
  const ElementShape s = element_shape<Tet4>(ElementNodes<Tet4>(ElementNodes<Tet4>::Constant(5.0)));
  CHECK(s.quality == 0.0);
  CHECK(s.relative_volume == 0.0);
  CHECK(s.longest_edge == 0.0);
}

TEST_CASE("other elements are rated by their least Jacobian", "[mesh][quality]") {
  SECTION("cube") {
    const ElementNodes<user::Hex8> cube = 0.5 * user::Hex8::reference_nodes();
    const ElementShape s = element_shape<user::Hex8>(cube);
    CHECK_THAT(s.quality, WithinAbs(1.0, 1e-14));
    CHECK_THAT(s.volume, WithinRel(1.0, 1e-14));
  }
  SECTION("a hexahedron folded at one corner is inverted though its volume is positive") {
    ElementNodes<user::Hex8> x = user::Hex8::reference_nodes();
    x.row(6) << -0.9, -0.9, -0.9;
    const ElementShape s = element_shape<user::Hex8>(x);
    CHECK(s.volume > 0.0);
    CHECK(s.relative_volume < 0.0);
    CHECK(s.quality == 0.0);
  }
  SECTION("a straight quadratic tetrahedron has the quality of its corners") {
    ElementNodes<user::Tet10> x;
    const ElementNodes<Tet4> corners = regular_tetrahedron();
    for (int a = 0; a < 10; ++a)
      x.row(a) = (Tet4::shape(user::Tet10::reference_nodes().row(a).transpose()).transpose() * corners);
    const ElementShape s = element_shape<user::Tet10>(x);
    CHECK_THAT(s.quality, WithinAbs(1.0, 1e-13));
    CHECK_THAT(s.volume, WithinRel(8.0 / 3.0, 1e-13));
    x.row(4) = 0.95 * x.row(0) + 0.05 * x.row(1);  // mid-edge node pushed to a corner
    CHECK(element_shape<user::Tet10>(x).relative_volume < 0.0);
  }
}

TEST_CASE("every symmetric element can be reversed", "[mesh][repair]") {
  const auto check = []<class E>(E) {
    const auto order = detail::mirrored_order(detail::element_layout<E>);
    REQUIRE(order.has_value());
    const ElementNodes<E> x = E::reference_nodes();
    ElementNodes<E> y;
    for (int a = 0; a < E::nodes; ++a) y.row(a) = x.row((*order)[static_cast<std::size_t>(a)]);
    CHECK(element_shape<E>(x).relative_volume > 0.0);
    CHECK_THAT(element_shape<E>(y).relative_volume, WithinRel(-element_shape<E>(x).relative_volume, 1e-13));
    CHECK_THAT(element_shape<E>(y).volume, WithinRel(-E::reference_volume, 1e-13));
  };
  check(Tet4{});
  check(user::Tet10{});
  check(user::Hex8{});
}
