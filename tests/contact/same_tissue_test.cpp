// Adaptors that change nothing give the forces, flags and errors of the tissue to the last bit.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/cut/cuttable.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/same_tissue_laws.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <cmath>
#include <vector>

using namespace palpate;

namespace {

constexpr double radius = 8e-3;

/// Changes nothing.
template <class Tissue>
struct Unchanged : TissueAdaptor<Tissue> {
  using TissueAdaptor<Tissue>::TissueAdaptor;
};
/// Changes the compliance.
struct Softer : TissueAdaptor<test::Pad> {
  using TissueAdaptor::TissueAdaptor;
  Matrix3 compliance(int i, int j) const noexcept { return 1.5 * Matrix3(tissue().compliance(i, j)); }
  double compliance_bound(int j) const noexcept { return 1.5 * tissue().compliance_bound(j); }
  double compliance_floor() const noexcept { return tissue().compliance_floor(); }
  std::uint64_t compliance_revision() const noexcept { return tissue().compliance_revision(); }
};
/// Sums displacements itself, in an order of its own.
struct Summing : test::AnalyticTissue {
  Summing() : AnalyticTissue(10, 0.04, 1e-3, 1.7e-4) {}
  Vector3 displacement_of(int i, std::span<const VertexForce> forces) const noexcept {
    Vector3 all = Vector3::Zero(), own = Vector3::Zero();
    for (std::size_t k = forces.size(); k-- > 0;) {
      all += common() * forces[k].force.in_model_axes();
      if (forces[k].vertex == i) own += this->own() * forces[k].force.in_model_axes();
    }
    return all + own;
  }
};

/// From the air down to `depth` above a top at z = `top`, along it, and up again.
std::vector<ToolState> press_and_slide(const Eigen::Isometry3d& to_world, double top, double depth, int ticks = 600) {
  std::vector<ToolState> path;
  for (int i = 0; i < ticks; ++i) {
    ToolState& s = path.emplace_back();
    s.time = s.now = 1e-3 * i;
    const double u = static_cast<double>(i) / ticks, down = std::min(1.0, std::sin(3.14 * u) * 1.5);
    const double angle = 0.3 * u;
    s.orientation = {std::cos(angle), std::sin(angle), 0.0, 0.0};
    s.position = to_world * Vector3(0.0137 + 2e-3 * u, 0.0159 - 1e-3 * u, top + radius + 1e-3 - (1e-3 + depth) * down);
  }
  return path;
}

template <class Model>
Model pad(const SetupOptions& options = {.columns = ColumnFill::synchronous}, const char* touched = "z1") {
  return test::make_pad<Model>(touched, 1e4, {6, 6, 4}, options);
}

/// The laws for an adaptor and an adaptor of that.
template <class T>
void check_still(T& tissue, const ToolList& tools, std::span<const ToolState> path, const ServoOptions& options = {}) {
  const auto laws = [&](auto& same) {
    CHECK(testing::describe(testing::same_tissue_laws(tissue, same, tools, path, options)) == "");
  };
  Unchanged<T> adaptor(tissue);
  Unchanged<Unchanged<T>> twice(adaptor);
  laws(adaptor);
  laws(twice);
}

}  // namespace

TEST_CASE("a still tissue is the same through adaptors", "[contact][tissue]") {
  auto tissue = pad<test::Pad>();
  SECTION("where it is") {
    const auto path = press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 3e-3);
    check_still(tissue, SphereTool{.radius = radius}, path);
    check_still(tissue, SphereTool{.radius = radius}, path, {.contact = {.friction = 0.3}});
    check_still(tissue, CapsuleTool(radius, 3e-3), path);
  }
  SECTION("pressed so deep that it is flagged, in a pose") {
    testing::Random random(5);
    Eigen::Isometry3d pose(Eigen::Translation3d(0.3, -0.2, 0.1));
    pose.linear() = testing::random_rotation(random);
    tissue.set_pose(pose);
    const auto path = press_and_slide(pose, test::pad_height, 0.9 * radius);
    check_still(tissue, SphereTool{.radius = radius}, path);
    const auto ticks = testing::detail::run_session(tissue, SphereTool{.radius = radius}, path, {});
    CHECK(std::ranges::any_of(ticks, [](const auto& t) { return t.status.has(StatusFlag::large_displacement); }));
  }
  SECTION("moved by loads since its set-up") {
    tissue.set_conditions(Scene().fix("z0").touch("z1").traction("z1", Vector3(400.0, -100.0, -600.0)));
    const auto path = press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 3e-3);
    check_still(tissue, SphereTool{.radius = radius}, path);
    check_still(tissue, CapsuleTool(radius, 3e-3), path, {.contact = {.friction = 0.3}});
  }
  SECTION("with a sphere smaller than its facets") {
    const auto path = press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height - radius + 1e-3, 0.4e-3);
    check_still(tissue, SphereTool{.radius = 1e-3}, path);
  }
  SECTION("whose compliance is changed") {
    Softer softer(tissue);
    check_still(softer, SphereTool{.radius = radius},
                press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 3e-3));
  }
  SECTION("stored in float") {
    auto stored = pad<HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverseFloat>>>();
    check_still(stored, SphereTool{.radius = radius},
                press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 3e-3));
  }
  SECTION("that sums displacements itself") {
    Summing summing;
    std::vector<ToolState> path = press_and_slide(Eigen::Isometry3d::Identity(), 0.0, 3e-3);
    for (ToolState& s : path) s.position -= Vector3(0.0137, 0.0159, 0.0);
    check_still(summing, SphereTool{.radius = radius}, path);
  }
}

TEST_CASE("measured errors of forces are the same through adaptors", "[contact][tissue]") {
  Scene scene;
  scene.fix("z0").touch(where::sphere({0.015, 0.015, test::pad_height}, 6e-3), {.radius = radius});
  SetupOptions options;
  options.force_error = measured_force_error();
  HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>> tissue(
      box_tet4(Vector3(0.03, 0.03, test::pad_height), {8, 8, 6}), scene,
      LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.45}, options);
  const auto path = press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 2e-3, 300);
  ServoOptions corrected;
  corrected.corrected_force = true;
  check_still(tissue, SphereTool{.radius = radius}, path);
  check_still(tissue, SphereTool{.radius = radius}, path, corrected);
  const auto ticks = testing::detail::run_session(tissue, SphereTool{.radius = radius}, path, {});
  CHECK(std::ranges::any_of(ticks, [](const auto& t) { return t.error.force > 0.0 && t.error.bound < infinity; }));
}

TEST_CASE("tissue that moves or is cut is the same through adaptors", "[contact][tissue]") {
  const auto path = press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 3e-3, 200);
  const auto check = [&](auto& tissue, auto& second) {
    Unchanged<std::remove_reference_t<decltype(second)>> adaptor(second);
    CHECK(testing::describe(testing::same_tissue_laws(tissue, adaptor, SphereTool{.radius = radius}, path)) == "");
  };
  const Mesh<Tet4> mesh = box_tet4(Vector3(0.03, 0.03, test::pad_height), {4, 4, 3});
  const Scene scene = Scene().fix("z0").touch("z1");
  SECTION("moves") {
    using Moving = HapticFEModel<Tet4, NeoHookean, Implicit<QuasiNewton<>>>;
    const NeoHookean rubber{.youngs_modulus = 1e4, .poisson_ratio = 0.3, .density = 1000.0};
    Moving tissue(mesh, scene, rubber), second(mesh, scene, rubber);
    check(tissue, second);
  }
  SECTION("is cut") {
    using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
    const LinearElastic soft{.youngs_modulus = 1e4, .poisson_ratio = 0.3};
    Cut tissue(mesh, scene, soft), second(mesh, scene, soft);
    check(tissue, second);
  }
}

TEST_CASE("every law of the suite for a tissue in another form can fail", "[testing][tissue]") {
  auto tissue = pad<test::Pad>();
  const auto path = press_and_slide(Eigen::Isometry3d::Identity(), test::pad_height, 0.9 * radius);
  const auto laws = [&](auto& other) {
    return testing::same_tissue_laws(tissue, other, SphereTool{.radius = radius}, path);
  };
  SECTION("same surface") {
    auto whole = pad<test::Pad>({.columns = ColumnFill::synchronous}, "surface");
    CHECK(testing::violates(laws(whole), "same surface"));
  }
  SECTION("same pose") {
    auto moved = pad<test::Pad>();
    moved.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1e-12)));
    CHECK(testing::violates(laws(moved), "same pose"));
  }
  SECTION("same scales, forces, contacts and errors") {
    Softer softer(tissue);
    const auto v = laws(softer);
    CHECK(testing::violates(v, "same scales"));
    CHECK(testing::violates(v, "same force"));
    CHECK(testing::violates(v, "same contacts"));
    CHECK(testing::violates(v, "same error"));
    CHECK(testing::violates(v, "same status"));
  }
  SECTION("same hooks") {
    struct Announcing : TissueAdaptor<test::Pad> {
      using TissueAdaptor::TissueAdaptor;
      Status begin_tick() noexcept { return {}; }
    };
    Announcing announcing(tissue);
    CHECK(testing::violates(laws(announcing), "same hooks"));
  }
}
