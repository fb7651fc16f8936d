// One deliberate error for every check of the stiffness law suite.
#include <palpate/testing/assembler_laws.hpp>

#include "assembly/bodies.hpp"

using namespace test;
using testing::same_stiffness_laws;
using testing::stiffness_laws;
using testing::violates;

namespace {

/// Any matrix as a stiffness.
struct Given {
  MatrixX k;
  std::vector<Matrix3> blocks;
  double leftover = 0.0;  ///< part of the old y that is kept
  explicit Given(MatrixX matrix) : k(std::move(matrix)) {
    for (Index i = 0; i < k.rows() / 3; ++i) blocks.push_back(k.block<3, 3>(3 * i, 3 * i));
  }
  Index size() const { return k.rows(); }
  void apply(const VectorX& x, VectorX& y) const noexcept {
    if (leftover == 0.0)
      y = k * x;
    else
      y = (k * x + leftover * y).eval();
  }
  std::vector<Matrix3> diagonal_blocks() const { return blocks; }
  std::size_t bytes() const { return 8; }
};

const Body<Tet4> sphere = body_of(sphere_tet4(1.0, 1), {liver});
const MatrixX right = testing::dense_matrix(assemble_stiffness<Tet4>(sphere, {}));

}  // namespace

TEST_CASE("the law suite accepts the same matrix as a user-defined operator", "[testing][assembly]") {
  CHECK(testing::describe(stiffness_laws(sphere, Given(right))) == "");
  Body<Tet4> soft = sphere;
  for (Matrix6& d : soft.elasticity) d *= 1e-300;
  CHECK(testing::describe(stiffness_laws(soft, Given(1e-300 * right))) == "");
}

TEST_CASE("every check of the stiffness law suite can fail", "[testing][assembly]") {
  Given k(right);
  SECTION("symmetric") {
    k.k(0, 5) += 1e-9 * right.maxCoeff();
    CHECK(violates(stiffness_laws(sphere, k), "symmetric"));
  }
  SECTION("diagonal blocks agree") {
    k.blocks[3](1, 1) *= 1.0 + 1e-9;
    CHECK(violates(stiffness_laws(sphere, k), "diagonal blocks agree"));
    CHECK(violates(same_stiffness_laws(Given(right), k), "diagonal blocks agree"));
    k.blocks.pop_back();
    CHECK(violates(stiffness_laws(sphere, k), "diagonal blocks agree"));
  }
  SECTION("apply overwrites") {
    k.leftover = 0.5;
    CHECK(violates(stiffness_laws(sphere, k), "apply overwrites"));
  }
  SECTION("a spring to the ground removes the zero modes") {
    k.k(0, 0) += 1e-6 * right.maxCoeff();
    k.blocks[0] = k.k.topLeftCorner<3, 3>();
    const auto v = stiffness_laws(sphere, k);
    CHECK(violates(v, "translation costs nothing"));
    CHECK(violates(v, "exact zero modes"));
    CHECK(violates(v, "affine patch"));
  }
  SECTION("a stiffness for translations only") {
    MatrixX springs = -MatrixX::Ones(right.rows() / 3, right.rows() / 3);
    springs.diagonal().setConstant(static_cast<double>(springs.rows() - 1));
    k.k.setZero();
    for (int c = 0; c < 3; ++c)
      for (Index i = 0; i < springs.rows(); ++i)
        for (Index j = 0; j < springs.rows(); ++j) k.k(3 * i + c, 3 * j + c) = springs(i, j);
    const auto v = stiffness_laws(sphere, Given(k.k));
    CHECK(violates(v, "rotation costs nothing"));
    CHECK_FALSE(violates(v, "translation costs nothing"));
  }
  SECTION("13 times too stiff: only the patch test detects it") {
    const auto v = stiffness_laws(sphere, Given(13.0639 * right));
    CHECK(violates(v, "affine patch"));
    CHECK(violates(v, "affine energy"));
    CHECK_FALSE(violates(v, "exact zero modes"));
    CHECK_FALSE(violates(v, "rotation costs nothing"));
  }
  SECTION("wrong sign") {
    CHECK(violates(stiffness_laws(sphere, Given(-right)), "no negative mode"));
  }
  SECTION("size and finiteness") {
    CHECK(violates(stiffness_laws(sphere, Given(right.topLeftCorner(3, 3))), "size"));
    CHECK(violates(same_stiffness_laws(Given(right), Given(right.topLeftCorner(3, 3))), "size"));
    k.k(2, 2) = std::numeric_limits<double>::quiet_NaN();
    CHECK(violates(stiffness_laws(sphere, k), "finite"));
  }
  SECTION("products agree") {
    k.k *= 1.0 + 1e-9;
    CHECK(violates(same_stiffness_laws(Given(right), k), "products agree"));
  }
}
