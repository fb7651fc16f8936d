// Nodal loads of elements and faces.
#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/local/stiffness.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"
#include "element/user_elements.hpp"
#include "local/closed_form.hpp"

using namespace test;

namespace {

template <Element E>
detail::FaceNodes<typename E::Face> face_of(const ElementNodes<E>& x, std::size_t face) {
  detail::FaceNodes<typename E::Face> f;
  for (int a = 0; a < E::Face::nodes; ++a) f.row(a) = x.row(E::faces[face][static_cast<std::size_t>(a)]);
  return f;
}

template <Element E>
ElementNodes<E> stretched() {
  Matrix3 axes;
  axes << 1.5, 0.2, -0.1, 0.3, 0.9, 0.4, 0.1, -0.2, 1.1;
  return E::reference_nodes() * axes.transpose();
}

template <Element E>
double volume_of(const ElementNodes<E>& x) {
  double volume = 0.0;
  for (const auto& q : E::Quadrature::points)
    volume += detail::point_geometry<E>(x, detail::reference_point(q), q.weight).volume;
  return volume;
}

/// Sums over the closed surface of an element under unit inward pressure.
struct SurfaceSums {
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  double area = 0.0, flux = 0.0;
};

template <class E>
SurfaceSums surface_sums(const ElementNodes<E>& x) {
  SurfaceSums sums;
  for (std::size_t f = 0; f < E::faces.size(); ++f) {
    const auto nodes = face_of<E>(x, f);
    const auto vectors = detail::shape_area_vectors<typename E::Face>(nodes);
    for (int a = 0; a < E::Face::nodes; ++a) {
      const Vector3 load = vectors.row(a).transpose(), at = nodes.row(a).transpose();
      sums.force += load;
      sums.moment += at.cross(load);
      sums.flux += at.dot(load);
    }
    sums.area += detail::shape_areas<typename E::Face>(nodes).sum();
  }
  return sums;
}

}  // namespace

TEST_CASE("a quarter of the volume goes to each node of Tet4", "[local][loads]") {
  testing::Random random(19);
  const ElementNodes<Tet4> x = random_tetrahedron(random);
  Tet4Nodes<double> g;
  const double volume = closed_form_gradients<double>(x, g);
  const auto v = detail::shape_volumes<Tet4>(x);
  for (int a = 0; a < 4; ++a) CHECK_THAT(v[a], Catch::Matchers::WithinRel(volume / 4, 1e-13));
}

TEST_CASE("a third of the area goes to each node of Tri3, outward", "[local][loads]") {
  detail::FaceNodes<Tri3> x;
  x << 1, 2, 3, 4, 2, 3, 1, 4, 3;  // area 3, normal +z
  const auto areas = detail::shape_areas<Tri3>(x);
  const auto vectors = detail::shape_area_vectors<Tri3>(x);
  for (int a = 0; a < 3; ++a) {
    CHECK_THAT(areas[a], Catch::Matchers::WithinRel(1.0, 1e-14));
    CHECK(largest(vectors.row(a) - Eigen::RowVector3d(0, 0, 1)) < 1e-14);
  }
  x.row(1).swap(x.row(2));  // reversed order: the area is the same, the normal changes sign
  CHECK_THAT(detail::shape_areas<Tri3>(x).sum(), Catch::Matchers::WithinRel(3.0, 1e-14));
  CHECK_THAT(detail::shape_area_vectors<Tri3>(x)(0, 2), Catch::Matchers::WithinRel(-1.0, 1e-14));
}

TEMPLATE_TEST_CASE("sums of element loads", "[local][loads]", Tet4, Tet10, Hex8, Hex20, user::Hex8, user::Tet10) {
  using E = TestType;
  const ElementNodes<E> x = stretched<E>();
  const double volume = volume_of<E>(x);
  SECTION("a body force sums to force times volume") {
    CHECK_THAT(detail::shape_volumes<E>(x).sum(), Catch::Matchers::WithinRel(volume, 1e-13));
  }
  SECTION("a body force has the moment of a force at the centroid") {
    const Vector3 moment = x.transpose() * detail::shape_volumes<E>(x);  // integral of x; straight sides only
    const Vector3 centroid = x.colwise().mean().transpose();
    CHECK(largest(moment - volume * centroid) <= 1e-12 * volume);
  }
  SECTION("pressure on the closed surface has zero sum and zero moment") {
    const SurfaceSums sums = surface_sums<E>(x);
    CHECK(largest(sums.force) <= 1e-14 * sums.area);
    CHECK(largest(sums.moment) <= 1e-13 * sums.area);
    CHECK_THAT(sums.flux, Catch::Matchers::WithinRel(3 * volume, 1e-12));  // divergence theorem: outward
  }
  SECTION("an initial strain does no work in a rigid motion") {
    Vector6 strain;
    strain << 1e-3, -2e-3, 5e-4, 4e-4, -3e-4, 2e-4;
    const ElementNodes<E> f = detail::initial_strain_load<E>(x, orthotropic(), strain);
    Vector3 moment = Vector3::Zero();
    for (int a = 0; a < E::nodes; ++a) moment += Vector3(x.row(a).transpose()).cross(Vector3(f.row(a).transpose()));
    CHECK(largest(f.colwise().sum()) <= 1e-13 * largest(f));
    CHECK(largest(moment) <= 1e-13 * largest(f));
  }
  SECTION("an initial strain is cancelled by the displacement with that strain") {
    Matrix3 h;
    h << 1e-3, 2e-4, -1e-4, 3e-4, -2e-3, 4e-4, 5e-5, -6e-4, 5e-4;
    const Vector6 strain = voigt::strain_vector(0.5 * (h + h.transpose()));
    const ElementNodes<E> u = x * h.transpose(), f = detail::initial_strain_load<E>(x, orthotropic(), strain);
    Eigen::Matrix<double, 3 * E::nodes, 1> v, load;
    for (int a = 0; a < E::nodes; ++a) {
      v.template segment<3>(3 * a) = u.row(a).transpose();
      load.template segment<3>(3 * a) = f.row(a).transpose();
    }
    CHECK(largest(detail::element_stiffness<E>(x, orthotropic()) * v - load) <= 1e-12 * largest(load));
  }
}

TEST_CASE("loads far from the origin", "[local][loads][extreme][B2][M1]") {
  ElementNodes<Tet4> x = stretched<Tet4>();
  const auto volumes = detail::shape_volumes<Tet4>(x);
  const auto areas = detail::shape_area_vectors<Tri3>(face_of<Tet4>(x, 2));
  x.rowwise() += Eigen::RowVector3d(1000.1, -999.7, 1001.3);
  CHECK(largest(detail::shape_volumes<Tet4>(x) - volumes) <= 1e-11 * largest(volumes));
  CHECK(largest(detail::shape_area_vectors<Tri3>(face_of<Tet4>(x, 2)) - areas) <= 1e-11 * largest(areas));
}

TEST_CASE("strain of a linear field", "[local]") {
  testing::Random random(23);
  const ElementNodes<Tet4> x = random_tetrahedron(random);
  Matrix3 h;
  for (int i = 0; i < 3; ++i) h.col(i) = random.vector<3>(-1.0, 1.0);
  const auto g = detail::point_geometry<Tet4>(x, Vector3::Zero(), 1.0);
  ElementNodes<Tet4> u = x * h.transpose();
  u.rowwise() += Eigen::RowVector3d(5, -7, 11);
  const Vector6 e = strain(u, g.gradient);
  CHECK(largest(e - voigt::strain_vector(0.5 * (h + h.transpose()))) <= 1e-12);
  Vector6 by_blocks = Vector6::Zero();  // sum of B_a u_a is the same
  for (int a = 0; a < 4; ++a) by_blocks += strain_displacement(g.gradient.row(a).transpose()) * u.row(a).transpose();
  CHECK(largest(e - by_blocks) <= 1e-12);
}

TEST_CASE("a uniform traction on quadratic faces: zero or negative corner loads", "[local][loads]") {
  detail::FaceNodes<Tri6> triangle = detail::FaceNodes<Tri6>::Zero();
  triangle.leftCols<2>() = Tri6::reference_nodes();
  const auto t = detail::shape_areas<Tri6>(triangle);
  CHECK(largest(t.head<3>()) <= 1e-16);
  CHECK(largest(t.tail<3>() - Vector3::Constant(1.0 / 6.0)) <= 1e-15);
  detail::FaceNodes<Quad8> square = detail::FaceNodes<Quad8>::Zero();
  square.leftCols<2>() = Quad8::reference_nodes();
  const auto q = detail::shape_areas<Quad8>(square);
  CHECK(largest(q.head<4>() - Eigen::Vector4d::Constant(-4.0 / 12.0)) <= 1e-15);
  CHECK(largest(q.tail<4>() - Eigen::Vector4d::Constant(4.0 / 3.0)) <= 1e-15);
}

TEMPLATE_TEST_CASE("pressure on a closed curved surface sums to zero", "[local][loads]", Tet10, Hex20) {
  using E = TestType;
  testing::Random random(31);
  ElementNodes<E> x = stretched<E>();
  for (int a = 0; a < E::nodes; ++a) x.row(a) += random.vector<3>(-0.03, 0.03).transpose();
  const SurfaceSums sums = surface_sums<E>(x);
  CHECK(largest(sums.force) <= 1e-14);
  CHECK(largest(sums.moment) <= 1e-13);
  CHECK_THAT(sums.flux, Catch::Matchers::WithinRel(3 * detail::shape_volumes<E>(x).sum(), 1e-13));
}
