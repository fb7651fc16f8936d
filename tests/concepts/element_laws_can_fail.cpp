// A deliberate break for every element law: a law that cannot fail tests nothing.
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/testing/element_laws.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;
using testing::describe;
using testing::element_laws;
using testing::face_element_laws;
using testing::violates;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct SwappedFunctions : Tet4 {
  static Eigen::Vector4d shape(const Vector3& x) noexcept { return {x[0], 1 - x.sum(), x[1], x[2]}; }
};
struct ScaledFunctions : Tet4 {
  static Eigen::Vector4d shape(const Vector3& x) noexcept { return 0.9 * Tet4::shape(x); }
};
struct NonFiniteFunctions : Tet4 {
  static Eigen::Vector4d shape(const Vector3& x) noexcept { return not_a_number * Tet4::shape(x); }
};
struct ShiftedGradient : Tet4 {
  static Eigen::Matrix<double, 4, 3> gradient(const Vector3& x) noexcept { return Tet4::gradient(x).array() + 1e-6; }
};
struct ScaledGradient : Tet4 {
  static Eigen::Matrix<double, 4, 3> gradient(const Vector3& x) noexcept { return 1.000001 * Tet4::gradient(x); }
};
struct OtherNodes : Tet4 {  // right functions, moved nodes: the field x is no longer reproduced
  static Eigen::Matrix<double, 4, 3> reference_nodes() noexcept { return 1.01 * Tet4::reference_nodes(); }
};
struct Overstated : Tet4 {
  static constexpr int order = 2;
};
struct Understated : user::Tet10 {
  static constexpr int order = 1;
};
struct InwardFace : Tet4 {
  static constexpr std::array<std::array<int, 3>, 4> faces{{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
};
struct FaceTwice : Tet4 {
  static constexpr std::array<std::array<int, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {0, 2, 1}, {0, 3, 2}}};
};
struct FaceOutOfRange : Tet4 {
  static constexpr std::array<std::array<int, 3>, 4> faces{{{1, 3, 2}, {1, 2, 4}, {2, 3, 4}, {1, 4, 3}}};  // from one
};
struct OpenTube : user::Hex8 {  // two opposite faces missing: their area vectors cancel
  static constexpr std::array<std::array<int, 4>, 4> faces{{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}}};
};
struct BentFace : user::Hex8 {
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 3, 6, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 4, 7, 3}, {1, 2, 6, 5}}};
};
struct FaceThroughTheMiddle : user::Hex8 {
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 6, 7}, {2, 3, 7, 6}, {0, 4, 7, 3}, {1, 2, 6, 5}}};
};
struct MidNodesMixedUp : user::Tet10 {
  static constexpr std::array<std::array<int, 6>, 4> faces{
      {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 7, 8}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}}};
};
struct VolumeOfACube : Tet4 {
  static constexpr double reference_volume = 1.0;
};
struct RuleOfAnotherDomain : Tet4 {
  using Quadrature = user::TensorRule<1, 3>;
};
struct MassRuleOfAnotherDomain : Tet4 {
  using MassQuadrature = user::TensorRule<2, 3>;
};
struct OnePointMass : Tet4 {
  using MassQuadrature = TetrahedronRule<1>;
};
struct OnePointQuadratic : user::Tet10 {
  using Quadrature = TetrahedronRule<1>;
};
struct LeftHanded : Tet4 {
  static constexpr std::array<std::array<int, 3>, 4> faces{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}}};
  static Eigen::Vector4d shape(const Vector3& x) noexcept { return {1 - x.sum(), x[1], x[0], x[2]}; }
  static Eigen::Matrix<double, 4, 3> reference_nodes() noexcept {
    Eigen::Matrix<double, 4, 3> x = Tet4::reference_nodes();
    x.row(1).swap(x.row(2));
    return x;
  }
  static Eigen::Matrix<double, 4, 3> gradient(const Vector3&) noexcept {
    Eigen::Matrix<double, 4, 3> g = Tet4::gradient(Vector3::Zero());
    g.row(1).swap(g.row(2));
    return g;
  }
};
struct TriangleWithSquareRule : Tri3 {
  using Quadrature = user::TensorRule<1, 2>;
};
struct OnePointTri6 : user::Tri6 {
  using Quadrature = TriangleRule<1>;
};
struct TriangleOutOfRange : Quad4 {
  static constexpr std::array<std::array<int, 3>, 2> triangles{{{0, 1, 2}, {0, 2, 4}}};
};
struct RotatedTriangle : Quad4 {
  static constexpr std::array<std::array<int, 3>, 2> triangles{{{0, 1, 2}, {0, 3, 2}}};
};
struct HalfCovered : Quad4 {
  static constexpr std::array<std::array<int, 3>, 1> triangles{{{0, 1, 2}}};
};
struct CornersCoverTri6 : Tri6 {  // covers the face, but a neighbour may share only the mid-edge nodes
  static constexpr std::array<std::array<int, 3>, 1> triangles{{{0, 1, 2}}};
};
struct CollinearTriangle : Tri3 {
  static Eigen::Matrix<double, 3, 2> reference_nodes() noexcept {
    Eigen::Matrix<double, 3, 2> x;
    x << 0, 0, 1, 0, 0.5, 0;
    return x;
  }
};
struct BrokenFace : Tet4 {
  using Face = TriangleWithSquareRule;
};

template <class E>
bool breaks(const char* law) {
  const auto v = element_laws<E>();
  UNSCOPED_INFO(describe(v));
  return violates(v, law);
}

}  // namespace

TEST_CASE("shape function laws can fail", "[testing][element]") {
  CHECK(breaks<SwappedFunctions>("Kronecker delta"));
  CHECK(breaks<ScaledFunctions>("partition of unity"));
  CHECK(breaks<ShiftedGradient>("zero-sum gradients"));
  CHECK(breaks<ScaledGradient>("gradient is the derivative"));
  CHECK_FALSE(breaks<ScaledGradient>("zero-sum gradients"));
  CHECK(breaks<OtherNodes>("linear completeness"));
  CHECK(breaks<Overstated>("polynomial completeness"));
  CHECK_FALSE(breaks<Overstated>("linear completeness"));
  CHECK(breaks<Understated>("order is not understated"));
  CHECK(breaks<LeftHanded>("right-handed numbering"));
}

TEST_CASE("NaN in the shape functions breaks every law that uses them", "[testing][element]") {
  for (const char* law : {"Kronecker delta", "partition of unity", "gradient is the derivative", "linear completeness",
                          "polynomial completeness", "face shape functions are the trace of the element's",
                          "MassQuadrature exact for products"}) {
    INFO(law);
    CHECK(breaks<NonFiniteFunctions>(law));
  }
}

TEST_CASE("face laws can fail", "[testing][element]") {
  CHECK(breaks<InwardFace>("face is outward"));
  CHECK(breaks<InwardFace>("faces are closed"));
  CHECK(breaks<FaceTwice>("faces are closed"));
  CHECK(breaks<FaceTwice>("reference cell"));
  CHECK(breaks<FaceOutOfRange>("face nodes in range"));
  CHECK(breaks<OpenTube>("faces enclose the reference volume"));
  CHECK_FALSE(breaks<OpenTube>("faces are closed"));
  CHECK(breaks<BentFace>("face is plane"));
  CHECK(breaks<FaceThroughTheMiddle>("face bounds the element"));
  CHECK(breaks<MidNodesMixedUp>("face shape functions are the trace of the element's"));
  CHECK(breaks<BrokenFace>("rule integrates the shape functions"));
}

TEST_CASE("volume and rule laws can fail", "[testing][element]") {
  CHECK(breaks<VolumeOfACube>("reference volume"));
  CHECK(breaks<VolumeOfACube>("faces enclose the reference volume"));
  CHECK(breaks<RuleOfAnotherDomain>("reference volume"));
  CHECK(breaks<MassRuleOfAnotherDomain>("reference volume"));
  CHECK(breaks<MassRuleOfAnotherDomain>("points inside"));
  CHECK(breaks<OnePointMass>("MassQuadrature exact for products"));
  CHECK(breaks<OnePointQuadratic>("degree of Quadrature"));
}

TEST_CASE("surface element laws can fail", "[testing][element]") {
  CHECK(face_element_laws<user::Quad4>().empty());
  CHECK(face_element_laws<user::Tri6>().empty());
  CHECK(violates(face_element_laws<TriangleWithSquareRule>(), "weights sum to the volume"));
  CHECK(violates(face_element_laws<OnePointTri6>(), "rule integrates the shape functions"));
  CHECK(violates(face_element_laws<CollinearTriangle>(), "reference cell"));
  CHECK(violates(face_element_laws<CollinearTriangle>(), "Kronecker delta"));
}

TEST_CASE("triangulation laws can fail", "[testing][element]") {
  const auto vertex_law = "every node is a vertex of a triangle, and is in no other";
  CHECK(face_element_laws<Quad8>().empty());
  CHECK(violates(face_element_laws<TriangleOutOfRange>(), "triangles name nodes of the face"));
  CHECK(violates(face_element_laws<RotatedTriangle>(), "triangles have the orientation of the face"));
  CHECK(violates(face_element_laws<HalfCovered>(), "triangles cover the face"));
  CHECK(violates(face_element_laws<CornersCoverTri6>(), vertex_law));
  CHECK_FALSE(violates(face_element_laws<CornersCoverTri6>(), "triangles cover the face"));
}
