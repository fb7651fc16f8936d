// Cutting until a body falls apart, exactly along features of the mesh, and under a tool.
#include <palpate/cut/cuttable.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

using CutSession = HapticServo;

struct ManyCuts {
  int cuts = 0, bodies = 0, detached = 0;
  std::uint64_t renewals = 0;
  double worst_error = 0.0, worst_mass = 0.0, worst_slew = 0.0, weakest = 1.0;
  Status seen;
};

Mesh<Tet4> body_to_cut(int kind) {
  if (kind == 0) return box_tet4({0.05, 0.05, 0.05}, {4, 4, 4});
  if (kind == 1) return box_tet4({0.06, 0.04, 0.03}, {5, 3, 3}, BoxSplit::six);
  if (kind == 2) return cylinder_tet4(0.03, 0.05, 3);
  return sphere_tet4(0.03, 1);
}
/// The lowest quarter is fixed.
Scene scene_of(const Mesh<Tet4>& mesh) {
  double low = infinity, high = -infinity;
  for (const Vector3& x : mesh.positions) low = std::min(low, x[2]), high = std::max(high, x[2]);
  std::vector<NodeId> constrained;
  for (NodeId node = 0; node < mesh.node_count(); ++node)
    if (mesh.position(node)[2] < low + 0.25 * (high - low)) constrained.push_back(node);
  return Scene().fix(constrained).touch("surface").gravity({0.0, 0.0, -9.81});
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

void masses(Cut& tissue, double whole, double& left, ManyCuts& all) {
  double constrained = 0.0, detached = 0.0, removed = 0.0, pieces = 0.0;
  tissue.read([&](const auto& t, const auto& p) {
    for (Index e = 0; e < t.mesh().element_count(); ++e)
      (t.state(e) == ElementState::supported  ? constrained
       : t.state(e) == ElementState::detached ? detached
                                              : removed) += p.mass(t.part(e));
    for (const detail::Fragment& piece : t.detached_fragments()) {
      for (const Index e : piece.elements)
        if (!t.is_removed(e)) pieces += p.mass(t.part(e));
      all.detached = std::max(all.detached, static_cast<int>(t.detached_fragments().size()));
    }
  });
  all.worst_mass =
      std::max(all.worst_mass,
               std::max(std::abs(constrained + detached + removed - whole), std::abs(pieces - detached)) / whole);
  left = constrained;
}

/// Cuts one body at random under a sphere that moves over it, until no element is supported or `most` cuts are made.
void cut_apart(int kind, std::uint64_t seed, int most, ManyCuts& all) {
  const auto mesh = body_to_cut(kind);
  Cut tissue(mesh, scene_of(mesh), LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1e3});
  CutSession servo(tissue, SphereTool{});
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  testing::Random random(seed);
  double whole = 0.0, left = 1.0, time = 0.0;
  tissue.read([&](const auto& t, const auto& p) {
    for (Index e = 0; e < t.mesh().element_count(); ++e) whole += p.mass(t.part(e));
  });
  Vector3 last = Vector3::Zero(), x = mesh.position(0);
  ++all.bodies;
  for (int k = 0; k < most && left > 0.0; ++k) {
    tissue.cut(random_order(mesh, random));
    ++all.cuts;
    for (int i = 0; i < 3; ++i) {
      if (i == 1)
        while (tissue.process_cuts()) {}
      ToolState s;
      s.position = x += random.vector<3>(-2e-3, 2e-3);
      if (x.norm() > 0.1) x = mesh.position(0);
      s.time = time += 1e-3;
      const GatedForce f = servo.tick({&s, 1})[0];
      REQUIRE(f.force().allFinite());
      REQUIRE(f.force().norm() <= limits.peak_force * (1.0 + 1e-12));
      REQUIRE(f.status.bits() < (1u << status_flag_count));
      REQUIRE(!f.status.has(StatusFlag::non_finite_force));
      all.worst_slew = std::max(all.worst_slew, (f.force() - last).norm() / (limits.slew_rate * limits.period));
      all.seen |= f.status;
      last = f.force();
    }
    masses(tissue, whole, left, all);
    const CutReport report = tissue.cut_report();
    REQUIRE(!report.failed);
    all.worst_error = std::max(all.worst_error, report.error);
    all.weakest = std::min(all.weakest, report.smallest);
  }
  all.renewals += tissue.cut_report().renewals;
}

void cut_many(int cuts, std::uint64_t seed, ManyCuts& all) {
  for (int kind = 0; all.cuts < cuts; kind = (kind + 1) % 4) cut_apart(kind, ++seed, cuts - all.cuts, all);
  INFO(all.cuts << " cuts of " << all.bodies << " bodies, at most " << all.detached << " detached fragments, "
                << all.renewals << " new factors, weakest direction " << all.weakest << ", error " << all.worst_error
                << ", mass " << all.worst_mass << ", slew " << all.worst_slew);
  CHECK(all.worst_error <= 1e-10);
  CHECK(all.worst_mass <= 1e-12);
  CHECK(all.worst_slew <= 1.0 + 1e-9);
  CHECK(all.detached > 0);
}

/// Smallest quality of an element that is not removed.
double least_quality(const Cut& tissue) {
  double least = 1.0;
  tissue.read([&](const auto& t, const auto&) {
    for (Index e = 0; e < t.mesh().element_count(); ++e)
      if (!t.is_removed(e)) least = std::min(least, element_shape<Tet4>(element_nodes<Tet4>(t.mesh(), e)).quality);
  });
  return least;
}

}  // namespace

TEST_CASE("many random cuts of several bodies", "[cut][extreme][F1][F3]") {
  ManyCuts all;
  cut_many(150, 100, all);
}

// test_extremes "[long]"
TEST_CASE("ten thousand random cuts of several bodies", "[.][long]") {
  ManyCuts all;
  cut_many(10000, 1000, all);
  WARN(all.cuts << " cuts of " << all.bodies << " bodies, at most " << all.detached << " detached fragments, "
                << all.renewals << " new factors, weakest direction " << all.weakest << ", error " << all.worst_error
                << ", mass " << all.worst_mass << ", slew " << all.worst_slew << ", status " << all.seen.bits());
}

TEST_CASE("cuts exactly through nodes, edges and faces, without area, and outside the body", "[cut][extreme][F2]") {
  const double inf = infinity, nan = std::numeric_limits<double>::quiet_NaN();
  const auto sheet = [](double x, double low, double high) {
    return BladeSweep{{x, -1, low}, {x, 1, low}, {x, -1, high}, {x, 1, high}};
  };
  const std::vector<BladeSweep> nothing{
      sheet(0.03, 0.03, 0.03),                                         // zero length
      {{0, 0, 0}, {0, 0, 0}, {0.06, 0.04, 0.03}, {0.06, 0.04, 0.03}},  // an edge of zero length
      sheet(0.2, 0, 1),                                                // outside
      sheet(nan, 0, 1),
      sheet(0.03, 0, inf),
      sheet(-inf, nan, inf)};  // no position
  const std::vector<BladeSweep> something{
      sheet(0.024, 0.012, 1),                                                 // through faces and nodes, down to one
      {{-1, 0, 0}, {-1, 0.04, 0.03}, {1, 0, 0}, {1, 0.04, 0.03}},             // through diagonals
      {{0, -1, 0.018}, {0.06, -1, 0.018}, {0, 1, 0.018}, {0.06, 1, 0.018}}};  // horizontal, between the layers
  const auto mesh = body_to_cut(1);
  const LinearElastic soft{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1e3};
  const Scene still = scene_of(mesh).gravity(Vector3::Zero());  // so that the cuts are at the given positions
  Cut one(mesh, still, soft), other(mesh, still, soft);
  const double floor = least_quality(one);
  for (const BladeSweep& s : nothing) {
    one.cut(s);
    CHECK(one.process_cuts());
    CHECK(!one.process_cuts());
    CHECK(one.cut_report().cuts == 0);
    CHECK(one.begin_tick().ok());
  }
  std::uint64_t cuts = 0;
  for (const BladeSweep& s : something)
    for (int again = 0; again < 2; ++again) {  // the second time all faces are already open
      for (Cut* t : {&one, &other}) {
        t->cut(s);
        while (t->process_cuts()) {}
        CHECK(t->begin_tick().ok());
      }
      if (again == 0) ++cuts;
      CHECK(one.cut_report().cuts == cuts);
      CHECK(one.cut_report().error <= 1e-10);
      CHECK(least_quality(one) == floor);  // no slivers: elements keep their shape
      REQUIRE(one.contact_surface().vertex_count() == other.contact_surface().vertex_count());
      CHECK((one.contact_surface().triangles() ==
             other.contact_surface().triangles()));  // ties are resolved the same way
      CHECK((one.compliance(5, 5) == other.compliance(5, 5)));
    }
}

TEST_CASE("the example organ, cut 60 times per second next to a tool: slew and energy limits are kept",
          "[cut][extreme][F3]") {
  const auto mesh = io::read_mesh<Tet4>(PALPATE_TEST_DATA "/../../examples/data/organ.msh");
  std::vector<NodeId> below;
  for (NodeId node = 0; node < mesh.node_count(); ++node)
    if (mesh.position(node)[2] < 0.0) below.push_back(node);
  Cut tissue(mesh, Scene().fix("ligament").fix(below).touch("front").gravity({0.0, 0.0, -9.81}),
             LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  const EnergyLimits energy = EnergyLimits::from(DeviceLimits{});
  CutSession servo(tissue, SphereTool{}, {}, EnergyTank(energy));
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  const Vector3 outward = Vector3(0.076, -0.408, 0.910).normalized();
  Vector3 middle = Vector3::Constant(infinity);  // of the patch, as deformed by gravity
  for (const Vector3& x : tissue.contact_surface().positions())
    if (const Vector3 p = tissue.to_world() * x - Vector3(-0.0285, -0.0298, 0.04); p.norm() < middle.norm()) middle = p;
  middle += Vector3(-0.0285, -0.0298, 0.04);
  Vector3 last = Vector3::Zero(), was = Vector3::Zero();
  double given = 0.0, dissipated = 0.0, worst_work = 0.0, worst_slew = 0.0, longest = 0.0, across_cut = 0.0;
  for (int i = 0; i < 600; ++i) {
    const int frame = (i - 300) * 60 / 1000;
    const bool cut = i >= 300 && frame != (i - 301) * 60 / 1000;
    if (cut) {  // 20 mm long, through the position of the tool
      const Vector3 from = middle + Vector3(-0.01 + 0.02 * frame / 18.0, 0, 0), to = from + Vector3(0.02 / 18.0, 0, 0);
      tissue.cut(BladeSweep{from - 8e-3 * outward, from + 0.01 * outward, to - 8e-3 * outward, to + 0.01 * outward});
      tissue.process_cuts();
    }
    ToolState s;
    s.time = 1e-3 * i;
    s.position = middle + (SphereTool{}.radius - std::min(4e-3, 2e-5 * i) + 1e-3 * std::sin(0.05 * i)) * outward;
    const GatedForce f = servo.tick({&s, 1})[0];
    REQUIRE(f.force().allFinite());
    REQUIRE(f.force().norm() <= limits.peak_force * (1.0 + 1e-12));
    const Vector3 path = i > 0 ? Vector3(s.position - was) : Vector3::Zero();
    given += last.dot(path);
    worst_work = std::max(worst_work, last.dot(path));
    dissipated += energy.damping * path.squaredNorm() / 1e-3;
    worst_slew = std::max(worst_slew, (f.force() - last).norm() / (limits.slew_rate * limits.period));
    if (cut) across_cut = std::max(across_cut, (f.force() - last).norm());
    longest = std::max(longest, f.force().norm());
    last = f.force();
    was = s.position;
    REQUIRE(given <= energy.allowance + energy.refill * s.time + dissipated + worst_work);
  }
  while (tissue.process_cuts()) {}
  const CutReport report = tissue.cut_report();
  INFO(report.cuts << " cuts, error " << report.error << ", " << longest << " N largest force, " << across_cut
                   << " N across a cut, " << worst_slew << " of the slew limit");
  CHECK(report.cuts >= 5);
  CHECK(report.error <= 1e-10);
  CHECK(longest > 0.1);
  CHECK(across_cut > 0.0);  // cuts change the force
  CHECK(worst_slew <= 1.0 + 1e-9);
}
