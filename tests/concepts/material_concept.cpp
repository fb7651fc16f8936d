#include <memory>
#include <palpate/material/linear_elastic.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

struct FiveByFive : LinearElastic {
  Eigen::Matrix<double, 5, 5> elasticity() const { return {}; }
};
struct FloatMatrix : LinearElastic {
  Eigen::Matrix<float, 6, 6> elasticity() const { return {}; }
};
struct DynamicMatrix : LinearElastic {
  MatrixX elasticity() const { return {}; }
};
struct NotConst : LinearElastic {
  Matrix6 elasticity() { return {}; }
};
struct NoElasticity {
  double density = 0.0;
  std::optional<SetupProblem> check() const { return {}; }
};
struct NoDensity {
  std::optional<SetupProblem> check() const { return {}; }
  Matrix6 elasticity() const { return {}; }
};
struct NoCheck {
  double density = 0.0;
  Matrix6 elasticity() const { return {}; }
};
struct BoolCheck {
  double density = 0.0;
  bool check() const { return true; }
  Matrix6 elasticity() const { return {}; }
};
struct Unique : LinearElastic {
  std::unique_ptr<int> table;
};
struct ByReference : NoElasticity {
  Matrix6 d = Matrix6::Identity();
  const Matrix6& elasticity() const { return d; }
};

}  // namespace

TEST_CASE("Material and LinearMaterial accept materials", "[concepts][material]") {
  STATIC_REQUIRE(Material<LinearElastic>);
  STATIC_REQUIRE(LinearMaterial<LinearElastic>);
  STATIC_REQUIRE(Material<NoElasticity>);
  STATIC_REQUIRE(LinearMaterial<ByReference>);
}

TEST_CASE("Material refuses types that are not materials", "[concepts][material]") {
  STATIC_REQUIRE_FALSE(Material<int>);
  STATIC_REQUIRE_FALSE(Material<Matrix6>);
  STATIC_REQUIRE_FALSE(Material<NoDensity>);
  STATIC_REQUIRE_FALSE(Material<NoCheck>);
  STATIC_REQUIRE_FALSE(Material<BoolCheck>);
  STATIC_REQUIRE_FALSE(Material<Unique>);
}

TEST_CASE("LinearMaterial refuses wrong shapes and scalars", "[concepts][material]") {
  STATIC_REQUIRE_FALSE(LinearMaterial<NoElasticity>);
  STATIC_REQUIRE_FALSE(LinearMaterial<FiveByFive>);
  STATIC_REQUIRE_FALSE(LinearMaterial<FloatMatrix>);
  STATIC_REQUIRE_FALSE(LinearMaterial<DynamicMatrix>);
  STATIC_REQUIRE_FALSE(LinearMaterial<NotConst>);
  STATIC_REQUIRE(Material<FiveByFive>);  // only the matrix is wrong
}
