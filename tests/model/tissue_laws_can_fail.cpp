// A deliberate violation of every law of the tissue law suite.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using testing::tissue_laws;
using testing::violates;

namespace {

/// Three vertices on springs; the third is constrained.
struct Springs : StillTissue {
  struct Surface {
    int vertex_count() const noexcept { return 3; }
  };
  MatrixX c = [] {
    MatrixX m = MatrixX::Zero(9, 9);
    m.topLeftCorner<6, 6>().setConstant(0.1);
    m.diagonal().head<6>().setConstant(1.0);
    return m;
  }();
  std::array<double, 3> bound{2.0, 2.0, 0.0};
  double floor = 1e-9;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  Status status;
  double drift = 0.0;

  Surface contact_surface() const noexcept { return {}; }
  Status require_columns(std::span<const int>) noexcept {
    c *= 1.0 + drift;
    return status;
  }
  Matrix3 compliance(int i, int j) const noexcept { return c.block<3, 3>(3 * i, 3 * j); }
  double compliance_bound(int j) const noexcept { return bound[static_cast<std::size_t>(j)]; }
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_floor() const noexcept { return floor; }
  const Eigen::Isometry3d& to_world() const noexcept { return frame; }
};
static_assert(TissueModel<Springs>);

testing::Violations laws(Springs tissue) {
  return tissue_laws(tissue, std::array{0, 1, 2});
}

}  // namespace

TEST_CASE("the tissue law suite accepts springs", "[testing][model]") {
  CHECK(testing::describe(laws({})) == "");
}

TEST_CASE("every law of the tissue law suite can fail", "[testing][model]") {
  Springs t;
  SECTION("columns available") {
    t.status = StatusFlag::degraded_model;
    CHECK(violates(laws(t), "columns available"));
  }
  SECTION("finite") {
    t.c(4, 0) = std::numeric_limits<double>::quiet_NaN();
    CHECK(violates(laws(t), "finite"));
  }
  SECTION("reciprocity") {
    t.c(3, 0) += 1e-6;
    CHECK(violates(laws(t), "reciprocity"));
  }
  SECTION("positive semidefinite, though every vertex is compliant") {
    t.c(3, 0) = t.c(0, 3) = 1.5;
    const auto v = laws(t);
    CHECK(violates(v, "positive semidefinite"));
    CHECK_FALSE(violates(v, "a loaded vertex moves"));
  }
  SECTION("a loaded vertex moves") {
    t.c.diagonal()[1] = -0.5;
    CHECK(violates(laws(t), "a loaded vertex moves"));
    t.c.setZero();
    CHECK(violates(laws(t), "something gives way"));
  }
  SECTION("bound really bounds") {
    t.bound[0] = 0.9;  // its own block has a singular value of 1.2
    CHECK(violates(laws(t), "bound really bounds"));
    t.bound = {2.0, 0.0, 0.0};
    CHECK(violates(laws(t), "bound really bounds"));
  }
  SECTION("floor") {
    t.floor = 0.0;
    CHECK(violates(laws(t), "floor is positive"));
    t.floor = 0.01;
    CHECK(violates(laws(t), "floor is tiny"));
  }
  SECTION("pose is rigid") {
    t.frame.linear() *= 1.001;
    CHECK(violates(laws(t), "pose is rigid"));
    t.frame.linear() = -Matrix3::Identity();
    CHECK(violates(laws(t), "pose is rigid"));
  }
  SECTION("same columns again") {
    t.drift = 1e-12;
    CHECK(violates(laws(t), "same columns again"));
  }
}
