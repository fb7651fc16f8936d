// Cuts along the sheet of a blade: the walls, the shapes of elements, and the compliance of what is left.
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/detail/apply_orders.hpp>
#include <palpate/cut/detail/cut_renewal.hpp>
#include <palpate/cut/detached_piece.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include <cmath>
#include <thread>

#include "catch.hpp"

using namespace palpate;

namespace straight_cuts {

namespace {

constexpr double side = 0.04;  // of the block, with facets of 4 mm
using Straight = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
const CutParameters straight{.cuttable = {}, .straight = true};
const LinearElastic soft{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0};

/// A block whose nodes are moved by up to a part of a cell: those on its surface along that.
Mesh<Tet4> uneven_block(BoxSplit split, double part, testing::Random& random, int cells = 10) {
  auto mesh = box_tet4({side, side, side}, {cells, cells, cells}, split);
  for (Vector3& x : mesh.positions)
    for (int c = 0; c < 3; ++c)
      if (x[c] > 1e-9 && x[c] < side - 1e-9) x[c] += part * side / cells * random.uniform(-1.0, 1.0);
  return mesh;
}
struct Sheet {
  Vector3 centre, normal;
  BladeSweep sweep;
  double distance(const Vector3& x) const { return std::abs((x - centre).dot(normal)); }
};
Sheet random_sheet(testing::Random& random, double length) {
  Vector3 normal(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
  normal.normalize();
  Vector3 centre;
  for (int c = 0; c < 3; ++c) centre[c] = side * random.uniform(0.3, 0.7);
  const Vector3 along = 0.5 * length * normal.unitOrthogonal(), across = normal.cross(along);
  return {centre,
          normal,
          {centre - along - across, centre - along + across, centre + along - across, centre + along + across}};
}
double worst_quality(const CutTopology<Tet4>& t) {
  double worst = 1.0;
  for (Index e = 0; e < t.mesh().element_count(); ++e)
    if (!t.is_removed(e)) worst = std::min(worst, t.quality(e));
  return worst;
}
std::vector<std::uint8_t> fixed_at(const Mesh<Tet4>& mesh, const char* group) {
  std::vector<std::uint8_t> constrained(mesh.positions.size(), 0);
  for (const NodeId node : mesh.find_group(group)->nodes) constrained[static_cast<std::size_t>(node)] = 7;
  return constrained;
}
detail::CutOrders::Taken order_of(const BladeSweep& sweep) {
  return {.order = {}, .sweeps = {sweep}, .count = 1};
}
/// One sweep through a body at rest.
detail::AppliedOrders<Tet4> cut(CutTopology<Tet4>& t, const BladeSweep& sweep, double least) {
  const auto is_fixed = [](NodeId) { return false; };
  detail::RestingEdges edges;
  return detail::apply_orders(
      t, order_of(sweep), Eigen::Isometry3d::Identity(), [&](NodeId node) { return t.mesh().position(node); }, edges,
      detail::FollowSheet<decltype(is_fixed)>{least, is_fixed});
}
/// The faces around every node, and of every face its other side.
void check_graph(const CutTopology<Tet4>& t) {
  for (Index e = 0; e < t.mesh().element_count(); ++e) {
    if (t.is_removed(e)) continue;
    for (const NodeId node : t.mesh().elements[static_cast<std::size_t>(e)])
      REQUIRE(std::ranges::count(t.elements_at(node), e) == 1);
    for (std::size_t f = 0; f < 4; ++f) {
      const Index other = t.neighbour(e, f);
      if (other < 0) continue;
      auto own = t.face_nodes({e, static_cast<int>(f)});
      std::ranges::sort(own);
      int found = 0;
      for (std::size_t g = 0; g < 4; ++g) {
        auto back = t.face_nodes({other, static_cast<int>(g)});
        std::ranges::sort(back);
        if (t.neighbour(other, g) == e && back == own) ++found;
      }
      REQUIRE(found == 1);
    }
  }
  for (std::size_t node = 0; node < t.mesh().positions.size(); ++node)
    for (const Index e : t.elements_at(static_cast<NodeId>(node)))
      REQUIRE(std::ranges::count(t.mesh().elements[static_cast<std::size_t>(e)], static_cast<NodeId>(node)) == 1);
}

}  // namespace

TEST_CASE("walls of a cut lie on the sheet of the blade, and elements keep half of the worst quality", "[cut]") {
  testing::Random random(3);
  int beside = 0;  // cuts that end on the rim of the support, where an edge can neither be moved nor divided
  for (const auto split : {BoxSplit::five_mirrored, BoxSplit::six})
    for (const double uneven : {0.0, 0.2})
      for (int k = 0; k < 12; ++k) {
        const auto mesh = uneven_block(split, uneven, random);
        CutTopology<Tet4> t(mesh, fixed_at(mesh, "z0"));
        const double before = worst_quality(t);
        const Sheet sheet = random_sheet(random, 0.03);
        const auto applied = cut(t, sheet.sweep, 0.5 * before);
        INFO("sheet " << sheet.normal.transpose() << " at " << sheet.centre.transpose() << ", uneven " << uneven);
        beside += applied.off_sheet > 0.1e-3 ? 1 : 0;
        CHECK(applied.off_sheet < 1.0e-3);
        CHECK(worst_quality(t) >= 0.5 * before);
        CHECK(!applied.change.copies.empty());
        double farthest = 0.0;
        for (const auto& f : applied.change.exposed)
          for (const NodeId node : t.face_nodes(f))
            farthest = std::max(farthest, sheet.distance(t.mesh().position(node)));
        CHECK(farthest <= applied.off_sheet + 0.1e-3);  // those of flat elements, too
        check_graph(t);
        double volume = 0.0;
        for (Index e = 0; e < t.mesh().element_count(); ++e) volume += t.volume(e);
        CHECK(std::abs(volume - side * side * side) < 1e-12 * side * side * side);  // its surface has not moved
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
          for (int c = 0; c < 3; ++c)
            for (const double wall : {0.0, side})
              if (std::abs(mesh.positions[i][c] - wall) < 1e-9)
                CHECK(std::abs(t.mesh().positions[i][c] - wall) < 1e-12);
      }
  CHECK(beside <= 1);  // of 48
}

TEST_CASE("a piece that a blade cuts off has the mass on its side of the sheet", "[cut]") {
  testing::Random random(8);
  const auto mesh = uneven_block(BoxSplit::five_mirrored, 0.1, random);
  for (const double at : {0.011, 0.0175, 0.026}) {
    Straight tissue(mesh, Scene().fix("z0").touch("z1"), soft, {}, straight);
    // Inclined: its height is `at` in the middle, and changes by 4 mm along x.
    const auto edge = [&](double x, double y) { return Vector3(x, y, at + 0.1 * (x - 0.5 * side)); };
    tissue.cut(BladeSweep{edge(-1.0, -1.0), edge(-1.0, 1.0), edge(1.0, -1.0), edge(1.0, 1.0)});
    while (tissue.process_cuts()) {}
    const auto pieces = detached_pieces(tissue);
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].mass == Catch::Approx(1000.0 * side * side * (side - at)).epsilon(2e-3));
    CHECK(tissue.cut_report().off_sheet < 0.1e-3);
  }
}

TEST_CASE("the compliance after straight cuts equals that of a new model", "[cut]") {
  testing::Random random(11);
  Vector6 swelling = Vector6::Zero();
  swelling.head<3>().setConstant(0.01);
  for (const auto split : {BoxSplit::five_mirrored, BoxSplit::six}) {
    const auto mesh = uneven_block(split, 0.15, random, 6);
    const Scene scene = Scene()
                            .fix("z0")
                            .gravity({0.0, 1.0, -9.81})
                            .traction("x1", {0.0, 20.0, 5.0})
                            .pressure("y1", 30.0)
                            .initial_strain(everywhere, swelling);
    const auto boundary = extract_boundary<Tet4>(mesh);
    const CutPhysics<Tet4> physics(make_body(mesh, soft), boundary, scene);
    CutTopology<Tet4> topology(mesh, resolve_essential(mesh, boundary, scene).constrained);
    const std::vector<NodeId> kept = mesh.find_group("z1")->nodes;
    detail::CutSystem<Tet4> system(topology, physics, kept);
    std::size_t divided = 0;
    std::unique_ptr<detail::CutRenewal<Tet4>> renewal;
    for (int k = 0; k < 5; ++k) {
      if (k == 2) renewal = std::make_unique<detail::CutRenewal<Tet4>>(topology, physics, kept, SetupLimits{});
      const auto applied = cut(topology, random_sheet(random, 0.02).sweep, 0.35);
      for (const auto& x : applied.change.elements) divided += x.added ? 1 : 0;
      system.fold();
      system.update(topology, applied.change);
      system.fold();
      CHECK(system.measured_error() < 1e-9);
      const auto check = [&](detail::CutSystem<Tet4>& updated) {
        detail::CutSystem<Tet4> fresh(topology, physics, kept);
        const auto step = updated.folded_step(), truth = fresh.folded_step();
        double wrong = 0.0, scale = 0.0;
        for (const NodeId a : kept)
          for (const NodeId b : kept)
            for (int c = 0; c < 3; ++c) {
              const double exact = (*truth)(fresh.index_of(a, c), fresh.index_of(b, 2));
              wrong = std::max(wrong, std::abs((*step)(updated.index_of(a, c), updated.index_of(b, 2)) - exact));
              scale = std::max(scale, std::abs(exact));
            }
        CHECK(wrong < 1e-9 * scale);
        updated.recover();
        const VectorX& u = updated.displacement();
        const VectorX& exact = fresh.displacement();
        double off = 0.0;
        for (Index node = 0; node < topology.mesh().node_count(); ++node)
          if (const auto& star = topology.elements_at(static_cast<NodeId>(node));
              !star.empty() && topology.state(star.front()) == ElementState::supported)
            off = std::max(off, (node_vector(u, node) - node_vector(exact, node)).norm());
        CHECK(off < 1e-9 * exact.cwiseAbs().maxCoeff());
      };
      check(system);
      if (k < 4) continue;
      while (!renewal->is_done()) std::this_thread::yield();
      const auto renewed = renewal->take(topology);
      REQUIRE(renewed);
      check(*renewed);
    }
    CHECK(divided > 0);
  }
}

TEST_CASE("tractions and pressure act on the moved and divided elements as on the whole", "[cut]") {
  testing::Random random(4);
  const auto mesh = uneven_block(BoxSplit::six, 0.2, random, 6);
  const auto boundary = extract_boundary<Tet4>(mesh);
  const Vector3 traction(3.0, -2.0, 5.0);
  const CutPhysics<Tet4> physics(
      make_body(mesh, soft), boundary,
      Scene().fix("z0").traction("x1", traction).pressure("z1", 40.0).body_load(everywhere, {0.0, 7.0, 0.0}));
  CutTopology<Tet4> t(mesh, fixed_at(mesh, "z0"));
  const auto total = [&] {
    Vector3 sum = Vector3::Zero();
    for (Index e = 0; e < t.mesh().element_count(); ++e)
      if (!t.is_removed(e)) {
        const auto f = physics.load_of(t.part(e));
        for (int a = 0; a < 4; ++a) sum += f.segment<3>(3 * a);
      }
    return sum;
  };
  const Vector3 whole = total();
  const double area = side * side;
  CHECK((whole - area * (traction + Vector3(0.0, 7.0 * side, -40.0))).norm() < 1e-12);
  for (int k = 0; k < 4; ++k) cut(t, random_sheet(random, 0.03).sweep, 0.1);
  CHECK((total() - whole).norm() < 1e-4 * whole.norm());  // flat elements have nearly no volume left
}

TEST_CASE("the drawn surface of a body with divided elements is closed", "[cut]") {
  testing::Random random(2);
  Straight tissue(uneven_block(BoxSplit::six, 0.2, random), Scene().fix("z0").touch("z1"), soft, {}, straight);
  VisualSurface before(tissue);
  std::size_t divided = 0;
  for (int k = 0; k < 6; ++k) {
    tissue.cut(random_sheet(random, 0.03).sweep);
    while (tissue.process_cuts()) {}
    tissue.read([&](const auto& topology, const auto&) {
      divided = topology.mesh().elements.size() - tissue.body().mesh.elements.size();
    });
    before.update();
    VisualSurface after(tissue);
    CHECK(before.triangles() == after.triangles());
    CHECK(before.exposed() == after.exposed());
    const auto size = static_cast<std::size_t>(3 * after.point_count());
    std::vector<float> positions(size), normals(size);
    REQUIRE(after.read_surface({}, positions, normals));
    Vector3 sum = Vector3::Zero();
    double skin = 0.0;
    for (const auto& t : after.triangles()) {
      const auto at = [&](int p) {
        const auto i = 3 * static_cast<std::size_t>(p);
        return Vector3(positions[i], positions[i + 1], positions[i + 2]);
      };
      const Vector3 area = 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
      sum += area;
      if (after.exposed()[static_cast<std::size_t>(t[0])] == 0) skin += area.norm();
    }
    CHECK(sum.norm() < 1e-8);
    CHECK(skin == Catch::Approx(6.0 * side * side).epsilon(1e-5));
  }
  CHECK(divided > 0);
}

TEST_CASE("short strokes cut as straight as one sweep, through a body that sags", "[cut][strokes]") {
  double mass = 0.0;  // of the piece that one sweep cuts off
  for (const double length : {0.06, 0.005, 0.001}) {
    testing::Random random(6);
    Straight tissue(uneven_block(BoxSplit::five_mirrored, 0.2, random),
                    Scene().fix("z1").touch("z0").gravity({0, 0, -9.81}), soft, {}, straight);
    const auto count = static_cast<int>(std::lround(0.06 / length));
    const auto edge = [&](int k, double y) {
      const double x = -0.01 + 0.06 * k / count;
      return Vector3(x, y, 0.017 + 0.1 * x);
    };
    double off = 0.0;
    for (int k = 0; k < count; ++k) {
      tissue.cut(BladeSweep{edge(k, -1.0), edge(k, 1.0), edge(k + 1, -1.0), edge(k + 1, 1.0)});
      while (tissue.process_cuts()) {}
      off = std::max(off, tissue.cut_report().off_sheet);
    }
    INFO("length of a stroke " << length);
    CHECK(off < 1.2e-3);  // a body that sags by 8 % moves between two strokes
    CHECK(tissue.cut_report().quality > 0.1);
    CHECK(tissue.cut_report().error < 1e-10);
    const auto pieces = detached_pieces(tissue);
    REQUIRE(pieces.size() == 1);
    if (mass == 0.0) mass = pieces[0].mass;
    CHECK(pieces[0].mass == Catch::Approx(mass).epsilon(0.02));
  }
}

TEST_CASE("a blade that turns about its tip, and one whose edge shrinks to a point, cut straight", "[cut]") {
  testing::Random random(9);
  const auto mesh = uneven_block(BoxSplit::six, 0.2, random);
  const Vector3 tip(0.02, -0.005, 0.02), first(0.02, 0.045, 0.02), last(0.05, 0.04, 0.02), high(0.0, 0.0, 0.011);
  for (const BladeSweep& fan : {BladeSweep{tip, first, tip, last}, BladeSweep{first, last, tip, tip},
                                BladeSweep{tip, tip, first, last}, BladeSweep{tip + high, first + high, tip, last}}) {
    CutTopology<Tet4> t(mesh, fixed_at(mesh, "z0"));
    const double least = 0.5 * worst_quality(t);
    const auto applied = cut(t, fan, least);
    CHECK(applied.off_sheet < 1e-3);
    CHECK(worst_quality(t) >= least);
    double area = 0.0;  // of both walls
    for (const auto& f : applied.change.exposed) {
      const auto nodes = t.face_nodes(f);
      const Vector3 a = t.mesh().position(nodes[0]);
      area += 0.5 * (t.mesh().position(nodes[1]) - a).cross(t.mesh().position(nodes[2]) - a).norm();
    }
    CHECK(area > 0.6 * 2.0 * fan.area() * 0.7);  // a part of the fan is outside of the block, its border stays closed
    CHECK(area < 1.5 * 2.0 * fan.area());
    check_graph(t);
  }
  CutTopology<Tet4> t(mesh, fixed_at(mesh, "z0"));
  CHECK(cut(t, BladeSweep{tip, first, tip, first}, 0.1).change.empty());  // no area
}

TEST_CASE("without the parameter cuts follow faces", "[cut]") {
  const auto mesh = box_tet4({side, side, side}, {5, 5, 5});
  Straight tissue(mesh, Scene().fix("z0").touch("z1"), soft);
  tissue.cut(BladeSweep{{0.021, -1, 0.02}, {0.021, 1, 0.02}, {0.021, -1, 0.1}, {0.021, 1, 0.1}});
  while (tissue.process_cuts()) {}
  CHECK(tissue.cut_report().off_sheet > 1e-3);
  tissue.read([&](const auto& topology, const auto&) {
    CHECK(topology.mesh().element_count() == mesh.element_count());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      CHECK(topology.mesh().positions[i] ==
            topology.mesh().positions[static_cast<std::size_t>(topology.origin_of(static_cast<NodeId>(i)))]);
  });
}

}  // namespace straight_cuts
