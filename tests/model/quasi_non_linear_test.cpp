// Linear tissue that stiffens along curves measured on a non-linear one.
#include <palpate/assembly/assembled.hpp>
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/static/stiffening.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include <Eigen/Cholesky>

#include "../contact/analytic_tissue.hpp"
#include "catch.hpp"

using namespace palpate;

namespace {

const NeoHookean rubber{5e3, 0.45, 1000.0};
const Vector3 block_size(0.06, 0.06, 0.03);
Mesh<Tet4> rubber_block() {
  return box_tet4(block_size, {4, 4, 3});
}
NodeId top_middle(const Mesh<Tet4>& mesh) {
  NodeId best = 0;
  const Vector3 wanted(0.5 * block_size[0], 0.5 * block_size[1], block_size[2]);
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if ((mesh.position(i) - wanted).norm() < (mesh.position(best) - wanted).norm()) best = i;
  return best;
}

/// The same block at small strain, with all nodes as vertices.
struct LinearBlock : StillTissue {
  struct Surface {
    int count;
    int vertex_count() const noexcept { return count; }
  };
  LinearBlock() {
    const Mesh<Tet4> mesh = rubber_block();
    const auto conditions = resolve_essential(mesh, extract_boundary<Tet4>(mesh), Scene().fix("z0"));
    const BlockMatrix k = assemble_stiffness<Tet4>(make_hyperelastic_body(mesh, std::vector{rubber}).rest, {});
    const Index n = k.size();
    MatrixX dense(n, n);
    for (Index j = 0; j < n; ++j) {
      VectorX column(n);
      k.apply(VectorX::Unit(n, j), column);
      dense.col(j) = column;
    }
    const auto& free = conditions.free_dofs;
    const MatrixX inverse =
        MatrixX(dense(free, free)).llt().solve(MatrixX::Identity(conditions.free_count(), conditions.free_count()));
    compliances = MatrixX::Zero(n, n);
    compliances(free, free) = 0.5 * (inverse + inverse.transpose());
    bound.resize(static_cast<std::size_t>(n / 3));
    for (Index j = 0; j < n / 3; ++j)
      for (Index i = 0; i < n / 3; ++i)
        bound[static_cast<std::size_t>(j)] =
            std::max(bound[static_cast<std::size_t>(j)], compliances.block<3, 3>(3 * i, 3 * j).norm());
  }
  Surface contact_surface() const noexcept { return {static_cast<int>(bound.size())}; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return compliances.block<3, 3>(3 * i, 3 * j); }
  double compliance_bound(int j) const noexcept { return bound[static_cast<std::size_t>(j)]; }
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_floor() const noexcept { return 1e-12; }
  const Eigen::Isometry3d& to_world() const noexcept { return frame; }

  MatrixX compliances;
  std::vector<double> bound;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
};

/// Force that keeps the middle of the top of the rubber at a displacement; omitted components are free.
Vector3 rubber_force(const Components& u) {
  const Mesh<Tet4> mesh = rubber_block();
  const NodeId node = top_middle(mesh);
  Equilibrium body(make_hyperelastic_body(mesh, std::vector{rubber}),
                   Scene().fix("z0").prescribe(std::vector<NodeId>{node}, u));
  REQUIRE(body.solve().converged);
  return body.reactions().segment<3>(3 * Index{node});
}
/// Curve measured by pressing down or pulling sideways.
StiffeningCurve measured(const LinearBlock& linear, int axis, double sign) {
  const int node = top_middle(rubber_block());
  std::vector<StiffeningCurve::Point> points{{0.0, 1.0}};
  for (int k = 1; k <= 8; ++k) {
    const double d = 1e-3 * k;
    Components u;
    u[static_cast<std::size_t>(axis)] = sign * d;
    points.push_back({d, sign * rubber_force(u)[axis] * linear.compliance(node, node)(axis, axis) / d});
  }
  return StiffeningCurve(points);
}
/// Force of the wrapped tissue after some ticks, with the given components of the vertex prescribed.
template <class Tissue>
Vector3 settled_force(Tissue& tissue, int node, const std::vector<int>& constrained, const Vector3& u) {
  Vector3 force = Vector3::Zero();
  for (int tick = 0; tick < 60; ++tick) {
    const Matrix3 c = tissue.compliance(node, node);
    const VectorX f = MatrixX(c(constrained, constrained)).llt().solve(VectorX(u(constrained)));
    force.setZero();
    for (std::size_t k = 0; k < constrained.size(); ++k) force[constrained[k]] = f[static_cast<Index>(k)];
    const VertexForce on{node, ModelVector(force)};
    tissue.end_tick({&on, 1});
  }
  return force;
}

}  // namespace

TEST_CASE("with constant curves the forces are those of the tissue, bit for bit", "[model][quasi_non_linear]") {
  test::AnalyticTissue plain(12, 0.06, 2e-3, 5e-4), same = plain;
  QuasiNonLinear wrapped(same, StiffeningCurve({{0.0, 1.0}, {0.01, 1.0}}));
  HapticServo a(plain, SphereTool{.radius = 0.01});
  HapticServo b(wrapped, SphereTool{.radius = 0.01});
  double most = 0.0;
  for (int k = 0; k < 300; ++k) {
    ToolState s;
    s.time = 1e-3 * k;
    s.position = {2e-5 * k, -1e-5 * k, 0.01 - 2e-5 * std::min(k, 200)};
    REQUIRE(a.tick({&s, 1})[0].force() == b.tick({&s, 1})[0].force());
    most = std::max(most, a.tick_view().contact_force().norm());
  }
  CHECK(most > 0.1);
  CHECK(wrapped.compliance_revision() == 0);
}

TEST_CASE("along the measured direction the force is that of the rubber", "[model][quasi_non_linear]") {
  LinearBlock linear;
  const int node = top_middle(rubber_block());
  QuasiNonLinear tissue(linear, measured(linear, 2, -1.0), measured(linear, 0, 1.0));
  double differs = 0.0;
  for (const double d : {0.5e-3, 2.5e-3, 4.5e-3, 7.5e-3}) {
    const double exact = rubber_force({std::nullopt, std::nullopt, -d})[2];
    const Vector3 found = settled_force(tissue, node, {2}, {0.0, 0.0, -d});
    CHECK(std::abs(found[2] / exact - 1.0) <= 0.02);
    differs = std::max(differs, std::abs(-d / linear.compliance(node, node)(2, 2) / exact - 1.0));
  }
  CHECK(differs > 0.1);  // error of the linear block
  const Vector3 back = settled_force(tissue, node, {2}, {0.0, 0.0, -1e-9});
  CHECK(std::abs(back[2] * linear.compliance(node, node)(2, 2) / -1e-9 - 1.0) <= 1e-4);
}

TEST_CASE("off the measured direction the force is more accurate than linear", "[model][quasi_non_linear]") {
  LinearBlock linear;
  const int node = top_middle(rubber_block());
  QuasiNonLinear tissue(linear, measured(linear, 2, -1.0), measured(linear, 0, 1.0));
  for (const double degrees : {15.0, 30.0}) {
    const double a = degrees * 3.14159265358979 / 180.0, d = 6e-3;
    const Vector3 u(d * std::sin(a), 0.0, -d * std::cos(a));
    const Vector3 exact = rubber_force({u[0], u[1], u[2]});
    const Vector3 found = settled_force(tissue, node, {0, 1, 2}, u);
    const Vector3 plain = linear.compliance(node, node).llt().solve(u);
    const double error = (found - exact).norm() / exact.norm(), of_linear = (plain - exact).norm() / exact.norm();
    INFO(degrees << " degrees: " << error << ", linear " << of_linear);
    CHECK(error <= 0.05);
    CHECK(error < of_linear);
  }
}

TEST_CASE("a stiffened tissue passes the tissue law suite", "[model][quasi_non_linear][laws]") {
  LinearBlock linear;
  const int node = top_middle(rubber_block());
  QuasiNonLinear tissue(linear, StiffeningCurve({{0.0, 1.0}, {5e-3, 3.0}}), StiffeningCurve({{0.0, 1.0}, {5e-3, 1.7}}));
  settled_force(tissue, node, {0, 1, 2}, {2e-3, 1e-3, -4e-3});
  REQUIRE(tissue.axial_ratio() > 1.5);
  REQUIRE(tissue.radial_ratio() != tissue.axial_ratio());
  CHECK(testing::describe(testing::tissue_laws(tissue, std::array{node, node - 1, node - 6, 0}, {1e-10})) == "");
  const std::uint64_t still = tissue.compliance_revision();
  settled_force(tissue, node, {0, 1, 2}, {2e-3, 1e-3, -4e-3});
  CHECK(tissue.compliance_revision() == still);  // a steady contact keeps its compliances
  const Vector3 force = settled_force(tissue, node, {0, 1, 2}, {2e-3, 1e-3, -4e-3});
  for (const double turn : {1e-9, -1e-9, 0.0}) {  // like rounding and sensor noise
    const VertexForce rotated{node, ModelVector(force + turn * force.unitOrthogonal() * force.norm())};
    tissue.end_tick({&rotated, 1});
  }
  CHECK(tissue.compliance_revision() == still);
  const VertexForce elsewhere{node, ModelVector(force + 0.1 * force.norm() * force.unitOrthogonal())};
  tissue.end_tick({&elsewhere, 1});
  CHECK(tissue.compliance_revision() != still);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const VertexForce bad{node, {none, 0.0, 0.0}};
  tissue.end_tick({&bad, 1});
  CHECK(tissue.compliance(node, node).allFinite());
}

TEST_CASE("invalid curves are refused", "[model][quasi_non_linear]") {
  using Points = std::vector<StiffeningCurve::Point>;
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const Points& bad :
       {Points{}, Points{{0.001, 1.0}}, Points{{0.0, 0.0}}, Points{{0.0, -1.0}}, Points{{0.0, none}},
        Points{{0.0, 1.0}, {0.0, 2.0}}, Points{{0.0, 1.0}, {none, 2.0}}, Points{{0.0, 1.0}, {0.002, 2.0}, {0.001, 3.0}},
        Points{{0.0, 1.0}, {0.01, infinity}}, Points{{0.0, 1.0}, {0.001, 4.0}, {0.002, 1.0}}})
    try {
      const StiffeningCurve curve(bad);
      FAIL("accepted");
    } catch (const SetupError& error) {
      CHECK(error.kind() == SetupErrorKind::bad_argument);
    }
  const StiffeningCurve good({{0.0, 1.0}, {0.01, 2.0}, {0.02, 1.8}});
  CHECK(good.ratio(-1.0) == 1.0);
  CHECK(good.ratio(0.005) == 1.5);
  CHECK(good.ratio(5.0) == 1.8);
  CHECK(good.ratio(none) == 1.0);
}
