#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>

#include "catch.hpp"
#include "element/thesis_tet4.hpp"
#include "element/user_elements.hpp"

using namespace palpate;

namespace {

struct WideGradient : Tet4 {
  static Eigen::Matrix<double, 3, 4> gradient(const Vector3&) noexcept { return {}; }  // transposed
};
struct DynamicShape : Tet4 {
  static VectorX shape(const Vector3&) noexcept { return {}; }
};
struct FloatNodes : Tet4 {
  static Eigen::Matrix<float, 4, 3> reference_nodes() noexcept { return {}; }
};
struct ThrowingShape : Tet4 {
  static Eigen::Vector4d shape(const Vector3&) { return {}; }
};
struct QuadFaces : Tet4 {
  static constexpr std::array<std::array<int, 4>, 4> faces{};  // Face has three nodes
};
struct FlatRule : Tet4 {
  using Quadrature = TriangleRule<1>;
};
struct NoOrder {
  static constexpr int nodes = 4;
};
struct NoMassRule : Tet4 {
  using MassQuadrature = void;
};
struct OrderZero : Tet4 {
  static constexpr int order = 0;
};
struct FaceWithSolidRule : Tri3 {
  using Quadrature = TetrahedronRule<1>;
};
struct FaceWithWideGradient : Tri3 {
  static Eigen::Matrix<double, 3, 3> gradient(const Vector2&) noexcept { return {}; }
};
struct CornersOnly : Quad4 {
  static constexpr std::array<std::array<int, 4>, 1> triangles{};  // triangles have three nodes
};
struct ScaledShape : Tet4 {
  static Eigen::Vector4d shape(const Vector3& xi) noexcept { return 0.9 * Tet4::shape(xi); }
};

}  // namespace

TEST_CASE("Element accepts elements", "[concepts][element]") {
  STATIC_REQUIRE(Element<Tet4>);
  STATIC_REQUIRE(Element<thesis::ThesisTet4>);
  STATIC_REQUIRE(Element<user::Hex8>);
  STATIC_REQUIRE(Element<user::Tet10>);
  STATIC_REQUIRE(Element<Tet10>);
  STATIC_REQUIRE(Element<Hex8>);
  STATIC_REQUIRE(Element<Hex20>);
  STATIC_REQUIRE(Element<WithQuadrature<Tet10, TetrahedronRule<5>>>);
  STATIC_REQUIRE(FaceElement<Tri3>);
  STATIC_REQUIRE(FaceElement<user::Quad4>);
  STATIC_REQUIRE(FaceElement<user::Tri6>);
}

TEST_CASE("a face can be touched if it has triangles", "[concepts][element]") {
  STATIC_REQUIRE(TriangulatedFace<Tri3>);
  STATIC_REQUIRE(TriangulatedFace<Tri6>);
  STATIC_REQUIRE(TriangulatedFace<Quad4>);
  STATIC_REQUIRE(TriangulatedFace<Quad8>);
  STATIC_REQUIRE_FALSE(TriangulatedFace<user::Tri6>);
  STATIC_REQUIRE_FALSE(TriangulatedFace<CornersOnly>);
  STATIC_REQUIRE_FALSE(TriangulatedFace<Tet4>);
}

TEST_CASE("Element refuses types that are not elements", "[concepts][element]") {
  STATIC_REQUIRE_FALSE(Element<int>);
  STATIC_REQUIRE_FALSE(Element<void>);
  STATIC_REQUIRE_FALSE(Element<NoOrder>);
  STATIC_REQUIRE_FALSE(Element<Tri3>);
  STATIC_REQUIRE_FALSE(Element<TetrahedronRule<1>>);
  STATIC_REQUIRE_FALSE(Element<const Tet4*>);
}

TEST_CASE("Element refuses wrong shapes, scalars and promises", "[concepts][element]") {
  STATIC_REQUIRE_FALSE(Element<WideGradient>);
  STATIC_REQUIRE_FALSE(Element<DynamicShape>);
  STATIC_REQUIRE_FALSE(Element<FloatNodes>);
  STATIC_REQUIRE_FALSE(Element<ThrowingShape>);
  STATIC_REQUIRE_FALSE(Element<QuadFaces>);
  STATIC_REQUIRE_FALSE(Element<FlatRule>);
  STATIC_REQUIRE_FALSE(Element<NoMassRule>);
  STATIC_REQUIRE_FALSE(Element<OrderZero>);
}

TEST_CASE("FaceElement refuses solid elements and solid rules", "[concepts][element]") {
  STATIC_REQUIRE_FALSE(FaceElement<int>);
  STATIC_REQUIRE_FALSE(FaceElement<Tet4>);
  STATIC_REQUIRE_FALSE(FaceElement<FaceWithSolidRule>);
  STATIC_REQUIRE_FALSE(FaceElement<FaceWithWideGradient>);
}

TEST_CASE("concepts check syntax only; the law suites check the meaning", "[concepts][element]") {
  STATIC_REQUIRE(Element<ScaledShape>);
  STATIC_REQUIRE(Element<thesis::PrintedFunction>);
  STATIC_REQUIRE(Element<thesis::PrintedDerivatives>);
}
