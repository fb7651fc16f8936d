// Signed distance to a closed and an open surface.
#include <palpate/contact/contact_surface.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

/// The surface of a box mesh, or of one of its sides.
ContactSurface surface_of(const Mesh<Tet4>& mesh, std::size_t only_axis = 3) {
  std::vector<Triangle> triangles;
  double top = -infinity;
  for (const Vector3& x : mesh.positions) top = std::max(top, x[2]);
  for (const auto& face : extract_boundary<Tet4>(mesh)) {
    const Triangle t{face.nodes[0], face.nodes[1], face.nodes[2]};
    const bool on_top =
        std::ranges::all_of(t, [&](int v) { return mesh.positions[static_cast<std::size_t>(v)][2] == top; });
    if (only_axis == 3 || on_top) triangles.push_back(t);
  }
  return {mesh.positions, triangles};
}

/// Exact signed distance to the box [0, size].
double box_distance(const Vector3& p, const Vector3& size) {
  const Vector3 q = (p - 0.5 * size).cwiseAbs() - 0.5 * size;
  return q.cwiseMax(Vector3::Zero()).norm() + std::min(q.maxCoeff(), 0.0);
}

}  // namespace

TEST_CASE("the signed distance of a box is exact everywhere", "[contact][surface]") {
  const Vector3 size(1.0, 0.8, 0.5);
  const BoxSplit split = GENERATE(BoxSplit::six, BoxSplit::five_mirrored);
  const ContactSurface surface = surface_of(box_tet4(size, {4, 3, 2}, split));
  testing::Random random(31);
  double worst = 0.0, worst_foot = 0.0, worst_direction = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const Vector3 p = Vector3(0.5, 0.4, 0.25) + random.vector<3>(-1, 1);
    const auto closest = surface.closest(p);
    worst = std::max(worst, std::abs(closest.distance - box_distance(p, size)));
    worst_foot = std::max(worst_foot, std::abs(box_distance(closest.point, size)));
    worst_direction = std::max(worst_direction, (closest.point + closest.distance * closest.outward - p).norm());
    worst_direction = std::max(worst_direction, std::abs(closest.outward.norm() - 1.0));
  }
  CHECK(worst <= 1e-12);
  CHECK(worst_foot <= 1e-12);
  CHECK(worst_direction <= 1e-12);
}

TEST_CASE("points outside corners and edges have the right sign", "[contact][surface]") {
  const ContactSurface surface = surface_of(box_tet4(Vector3(1, 1, 1), {2, 2, 2}, BoxSplit::six));
  for (double x : {0.0, 1.0})
    for (double y : {0.0, 1.0})
      for (double z : {0.0, 0.5, 1.0}) {
        const Vector3 corner(x, y, z);
        const Vector3 away(x - 0.5, y - 0.5, z - 0.5);
        CHECK_THAT(surface.closest(corner + 0.1 * away).distance, WithinAbs(0.1 * away.norm(), 1e-12));
        const auto inside = surface.closest(corner - 0.1 * away);
        CHECK(inside.distance < 0.0);
        CHECK_THAT(inside.distance, WithinAbs(-0.05, 1e-12));
        const auto on = surface.closest(corner);
        CHECK(std::abs(on.distance) <= 1e-15);
        CHECK(on.outward.dot(away.normalized()) > 0.5);
        // Along one axis only: the closest point is the corner or edge, next to faces that point away.
        for (int axis = 0; axis < 2; ++axis) {
          Vector3 side = Vector3::Zero();
          side[axis] = away[axis] > 0.0 ? 0.1 : -0.1;
          CHECK_THAT(surface.closest(corner + side).distance, WithinAbs(0.1, 1e-12));
        }
      }
}

TEST_CASE("on the surface the outward direction is the normal, not rounding", "[contact][surface][extreme][D3]") {
  const ContactSurface surface = surface_of(box_tet4(Vector3(0.03, 0.03, 0.02), {6, 6, 4}, BoxSplit::six));
  testing::Random random(34);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p(random.uniform(1e-4, 0.0299), random.uniform(1e-4, 0.0299),
                    0.02 + 1e-17 * static_cast<double>(i % 3 - 1));
    const auto closest = surface.closest(p);
    if (!(closest.outward[2] > 0.999)) FAIL(p.transpose() << ": outward " << closest.outward.transpose());
    if (!(std::abs(closest.distance) <= 1e-15)) FAIL(p.transpose() << ": distance " << closest.distance);
  }
  SUCCEED();
}

TEST_CASE("ties always give the same triangle", "[contact][surface]") {
  const ContactSurface surface = surface_of(box_tet4(Vector3(1, 1, 1), {4, 4, 4}, BoxSplit::five_mirrored));
  const ContactSurface again = surface_of(box_tet4(Vector3(1, 1, 1), {4, 4, 4}, BoxSplit::five_mirrored));
  for (const Vector3& p : {Vector3(0.5, 0.5, 0.5), Vector3(0.5, 0.5, 1.0), Vector3(0.25, 0.25, 1.0), Vector3(0, 0, 0),
                           Vector3(0.5, 0, 0)}) {
    const auto first = surface.closest(p);
    CHECK(first.triangle >= 0);
    for (int i = 0; i < 3; ++i) {
      const auto other = i == 0 ? again.closest(p) : surface.closest(p);
      CHECK(other.triangle == first.triangle);
      CHECK(other.point == first.point);
      CHECK(other.outward == first.outward);
      CHECK(other.distance == first.distance);
    }
  }
}

TEST_CASE("a moved surface gives the same results as a new one", "[contact][surface]") {
  Mesh<Tet4> mesh = box_tet4(Vector3(1, 1, 1), {3, 3, 3}, BoxSplit::six);
  ContactSurface moved = surface_of(mesh);
  testing::Random random(32);
  const Matrix3 turn = testing::random_rotation(random);
  for (Vector3& x : mesh.positions) x = turn * (2.0 * x) + Vector3(0.3, -0.1, 5.0);
  moved.move_to(mesh.positions);
  const ContactSurface fresh(mesh.positions, moved.triangles());
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = turn * random.vector<3>(-1, 3) + Vector3(0.3, -0.1, 5.0);
    const auto a = moved.closest(p), b = fresh.closest(p);
    if (a.triangle != b.triangle || std::abs(a.distance - b.distance) > 1e-12 || (a.outward - b.outward).norm() > 1e-9)
      FAIL("point " << p.transpose() << ": " << a.distance << ", " << b.distance);
  }
  for (int t = 0; t < static_cast<int>(moved.triangles().size()); ++t)
    if ((moved.normal(t) - fresh.normal(t)).norm() > 1e-12) FAIL("normal of triangle " << t);
  SUCCEED();
}

TEST_CASE("above and below an open surface the sign is that of the plane", "[contact][surface]") {
  const ContactSurface top = surface_of(box_tet4(Vector3(1, 1, 1), {3, 3, 3}, BoxSplit::six), 2);
  REQUIRE(top.triangles().size() == 18);
  testing::Random random(33);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p(random.uniform(0.01, 0.99), random.uniform(0.01, 0.99), random.uniform(0.5, 1.5));
    const auto closest = top.closest(p);
    if (std::abs(closest.distance - (p[2] - 1.0)) > 1e-12) FAIL(p.transpose() << ": " << closest.distance);
    if ((closest.outward - Vector3::UnitZ()).norm() > 1e-9) FAIL(p.transpose() << ": " << closest.outward.transpose());
  }
  SUCCEED();
}

TEST_CASE("a point beside the rim of an open surface is not inside", "[contact][surface][extreme][D3]") {
  const ContactSurface top = surface_of(box_tet4(Vector3(1, 1, 1), {3, 3, 3}, BoxSplit::six), 2);
  for (const Vector3& p :
       {Vector3(-0.5, 0.5, 0.9), Vector3(1.5, 0.4, 0.2), Vector3(-0.3, -0.3, 0.5), Vector3(0.5, -1e-3, 0.9999)}) {
    INFO(p.transpose());
    CHECK(top.closest(p).distance > 0.0);
  }
}

TEST_CASE("an empty surface has no closest point", "[contact][surface][extreme]") {
  const ContactSurface nothing;
  CHECK(nothing.closest(Vector3::Zero()).triangle == -1);
  CHECK(nothing.closest(Vector3::Zero()).distance == infinity);
  CHECK(nothing.vertex_count() == 0);
}
