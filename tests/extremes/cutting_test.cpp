#include <palpate/cut/cuttable_tissue.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_round.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

struct ManyCuts {
  int cuts = 0, bodies = 0, loose = 0;
  std::uint64_t renewals = 0;
  double worst_error = 0.0, worst_mass = 0.0, worst_slew = 0.0, weakest = 1.0;
  Status seen;
};

Mesh<Tet4> body(int kind) {
  if (kind == 0) return box_tet4({0.05, 0.05, 0.05}, {4, 4, 4});
  if (kind == 1) return box_tet4({0.06, 0.04, 0.03}, {5, 3, 3}, BoxSplit::six);
  if (kind == 2) return cylinder_tet4(0.03, 0.05, 3);
  return ball_tet4(0.03, 1);
}
/// What lies lowest is held.
Scene scene_of(const Mesh<Tet4>& mesh) {
  double low = infinity, high = -infinity;
  for (const Vector3& x : mesh.positions) low = std::min(low, x[2]), high = std::max(high, x[2]);
  std::vector<NodeId> held;
  for (NodeId node = 0; node < mesh.node_count(); ++node)
    if (mesh.position(node)[2] < low + 0.25 * (high - low)) held.push_back(node);
  return Scene().fix(held).touch("surface").gravity({0.0, 0.0, -9.81});
}

CutOrder random_order(const Mesh<Tet4>& mesh, testing::Random& random) {
  CutOrder order;
  const int count = 1 + static_cast<int>(random.uniform(0.0, 4.0));
  for (int k = 0; k < count; ++k) {
    const auto e = static_cast<Index>(random.uniform(0.0, static_cast<double>(mesh.element_count())));
    if (random.uniform() < 0.4)
      order.remove.push_back(e);
    else
      for (int f = 0; f < 4; ++f)
        if (random.uniform() < 0.6) order.open.push_back({e, f});
  }
  return order;
}

void masses(CuttableTissue<Tet4>& tissue, double whole, double& left, ManyCuts& all) {
  double held = 0.0, loose = 0.0, removed = 0.0, pieces = 0.0;
  tissue.read([&](const auto& t, const auto& p) {
    for (Index e = 0; e < t.mesh().element_count(); ++e)
      (t.state(e) == ElementState::held ? held : t.state(e) == ElementState::loose ? loose : removed) += p.mass(e);
    for (const LoosePiece& piece : t.loose_pieces()) {
      for (const Index e : piece.elements)
        if (!t.is_removed(e)) pieces += p.mass(e);
      all.loose = std::max(all.loose, static_cast<int>(t.loose_pieces().size()));
    }
  });
  all.worst_mass =
      std::max(all.worst_mass, std::max(std::abs(held + loose + removed - whole), std::abs(pieces - loose)) / whole);
  left = held;
}

/// Cuts one body at random under a ball that wanders over it, until nothing is held or `most` cuts are made.
void cut_apart(int kind, std::uint64_t seed, int most, ManyCuts& all) {
  const auto mesh = body(kind);
  CuttableTissue<Tet4> tissue(mesh, scene_of(mesh),
                              LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1e3});
  HapticServo servo(tissue, SphereTool{});
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  testing::Random random(seed);
  double whole = 0.0, left = 1.0, time = 0.0;
  tissue.read([&](const auto& t, const auto& p) {
    for (Index e = 0; e < t.mesh().element_count(); ++e) whole += p.mass(e);
  });
  Vector3 last = Vector3::Zero(), x = mesh.position(0);
  ++all.bodies;
  for (int k = 0; k < most && left > 0.0; ++k) {
    tissue.cut(random_order(mesh, random));
    ++all.cuts;
    for (int i = 0; i < 3; ++i) {
      if (i == 1) tissue.work();
      ToolState s;
      s.position = x += random.vector<3>(-2e-3, 2e-3);
      if (x.norm() > 0.1) x = mesh.position(0);
      s.time = time += 1e-3;
      const ToolForce f = servo.tick({&s, 1})[0];
      REQUIRE(f.force.allFinite());
      REQUIRE(f.force.norm() <= limits.peak_force * (1.0 + 1e-12));
      REQUIRE(f.status.bits() < (1u << status_flag_count));
      REQUIRE(!f.status.has(StatusFlag::non_finite_force));
      all.worst_slew = std::max(all.worst_slew, (f.force - last).norm() / (limits.slew_rate * limits.period));
      all.seen |= f.status;
      last = f.force;
    }
    masses(tissue, whole, left, all);
    const CutReport report = tissue.report();
    REQUIRE(!report.failed);
    all.worst_error = std::max(all.worst_error, report.error);
    all.weakest = std::min(all.weakest, report.smallest);
  }
  all.renewals += tissue.report().renewals;
}

void run(int cuts, std::uint64_t seed, ManyCuts& all) {
  for (int kind = 0; all.cuts < cuts; kind = (kind + 1) % 4) cut_apart(kind, ++seed, cuts - all.cuts, all);
  INFO(all.cuts << " cuts of " << all.bodies << " bodies, at most " << all.loose << " loose pieces, " << all.renewals
                << " new factors, weakest direction " << all.weakest << ", error " << all.worst_error << ", mass "
                << all.worst_mass << ", slew " << all.worst_slew);
  CHECK(all.worst_error <= 1e-10);
  CHECK(all.worst_mass <= 1e-12);
  CHECK(all.worst_slew <= 1.0 + 1e-9);
  CHECK(all.loose > 0);
}

}  // namespace

TEST_CASE("many random cuts of several bodies", "[cut][extreme][F1][F3]") {
  ManyCuts all;
  run(150, 100, all);
}

// test_cut "[long]" -s
TEST_CASE("ten thousand random cuts of several bodies", "[.][long]") {
  ManyCuts all;
  run(10000, 1000, all);
  WARN(all.cuts << " cuts of " << all.bodies << " bodies, at most " << all.loose << " loose pieces, " << all.renewals
                << " new factors, weakest direction " << all.weakest << ", error " << all.worst_error << ", mass "
                << all.worst_mass << ", slew " << all.worst_slew << ", status " << all.seen.bits());
}
