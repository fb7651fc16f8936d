#include <array>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <string>
#include <typeinfo>

#include "catch.hpp"

using namespace palpate;

#define PALPATE_TEST_TEXT2(x) #x
#define PALPATE_TEST_TEXT(x) PALPATE_TEST_TEXT2(x)

TEST_CASE("the ABI namespace contains the alignment of Eigen's members", "[core][config]") {
  const std::string name = PALPATE_TEST_TEXT(PALPATE_ABI);
  const std::string definitions = PALPATE_HEADER_ONLY ? "" : "_compiled";
  CHECK(name == "v0_align" + std::to_string(EIGEN_MAX_STATIC_ALIGN_BYTES) + definitions);
  // It is in every symbol: objects built with other flags do not link.
  CHECK_THAT(std::string(typeid(Status).name()), test::contains(name));
  STATIC_REQUIRE(std::is_same_v<palpate::Status, palpate::PALPATE_ABI::Status>);
}

TEST_CASE("fixed shapes are distinguished from convertible ones", "[core][types]") {
  STATIC_REQUIRE(FixedMatrix<Matrix6, 6, 6>);
  STATIC_REQUIRE(FixedMatrix<const Matrix6&, 6, 6>);
  STATIC_REQUIRE(FixedVector<Vector3, 3>);
  STATIC_REQUIRE_FALSE(FixedMatrix<Eigen::Matrix<double, 5, 5>, 6, 6>);
  STATIC_REQUIRE_FALSE(FixedMatrix<Eigen::Matrix<float, 6, 6>, 6, 6>);
  STATIC_REQUIRE_FALSE(FixedMatrix<MatrixX, 6, 6>);
  STATIC_REQUIRE_FALSE(FixedMatrix<double, 1, 1>);
  STATIC_REQUIRE_FALSE(FixedVector<Eigen::RowVector3d, 3>);
  STATIC_REQUIRE_FALSE(FixedVector<Eigen::Vector3f, 3>);
  STATIC_REQUIRE_FALSE(FixedVector<VectorX, 3>);
  STATIC_REQUIRE_FALSE(FixedVector<std::array<double, 3>, 3>);
  // The reason for the concept: plain convertibility gives the wrong answer.
  STATIC_REQUIRE(std::is_convertible_v<Eigen::Matrix<double, 5, 5>, Matrix6>);
}

TEST_CASE("indices are large enough for a dense compliance of a large surface", "[core][types]") {
  constexpr Index surface_nodes = 15447;
  STATIC_REQUIRE(9 * surface_nodes * surface_nodes > std::numeric_limits<std::int32_t>::max());
  STATIC_REQUIRE(sizeof(Index) == 8);
  STATIC_REQUIRE(sizeof(NodeId) == 4);
}
