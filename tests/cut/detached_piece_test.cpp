// Pieces that cuts detach have the mass, inertia and closed surface of the material that they are.
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/cut/detached_piece.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"
#include "refused.hpp"

#include <map>
#include <numeric>
#include <utility>
#include <vector>

using namespace palpate;

// Short names that other tests of this folder have, too.
namespace detached_piece_test {

namespace {

using Tissue = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

const Vector3 size(0.06, 0.04, 0.03);
constexpr double density = 1050.0, height = 0.01;  // of the layer that is cut off

Mesh<Tet4> block() {
  return box_tet4(size, {6, 4, 3}, BoxSplit::six);
}
Scene below() {
  return Scene().fix("z0").touch("surface");
}
/// A cut across the whole block below its upper layer, in the frame of a pose.
BladeSweep across(const Eigen::Isometry3d& pose) {
  const double z = size[2] - height;
  return {pose * Vector3(-1.0, -1.0, z), pose * Vector3(2.0, -1.0, z), pose * Vector3(-1.0, 2.0, z),
          pose * Vector3(2.0, 2.0, z)};
}

double volume_of(const DetachedPiece& piece) {
  double volume = 0.0;
  for (const auto& t : piece.triangles) {
    const auto at = [&](int k) {
      return Vector3(piece.points[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])] - piece.centre);
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6.0;
  }
  return volume;
}
/// Whether every edge has one triangle on each side.
bool is_closed(const DetachedPiece& piece) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : piece.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return !edges.empty();
}

}  // namespace

TEST_CASE("a layer that is cut off has the mass, inertia and surface of a box", "[cut][piece]") {
  testing::Random random(2);
  Eigen::Isometry3d pose(Eigen::Translation3d(0.2, -0.1, 0.3));
  pose.linear() = testing::random_rotation(random);
  Tissue tissue(block(), below(), LinearElastic{5e3, 0.4, density});
  tissue.set_pose(pose);
  CHECK(detached_pieces(tissue).empty());
  tissue.cut(across(pose));
  while (tissue.process_cuts()) continue;
  const std::vector<DetachedPiece> pieces = detached_pieces(tissue);
  REQUIRE(pieces.size() == 1);
  const DetachedPiece& piece = pieces.front();
  const double mass = density * size[0] * size[1] * height;
  CHECK(piece.mass == Catch::Approx(mass).epsilon(1e-12));
  CHECK((piece.centre - pose * Vector3(0.5 * size[0], 0.5 * size[1], size[2] - 0.5 * height)).norm() <= 1e-12);
  const auto about = [&](double a, double b) { return mass * (a * a + b * b) / 12.0; };
  const Vector3 moments(about(size[1], height), about(size[0], height), about(size[0], size[1]));
  const Matrix3 inertia = pose.linear() * moments.asDiagonal() * pose.linear().transpose();
  CHECK((piece.inertia - inertia).norm() <= 1e-10 * inertia.norm());
  CHECK(is_closed(piece));
  CHECK(volume_of(piece) == Catch::Approx(mass / density).epsilon(1e-10));
  CHECK(piece.elements.size() == block().elements.size() / 3);
  Eigen::Isometry3d far_away = pose;  // moments about the world's origin would cancel
  far_away.pretranslate(Vector3(1e4, -2e4, 0.0));
  tissue.set_pose(far_away);
  CHECK((detached_pieces(tissue).front().inertia - inertia).norm() <= 1e-6 * inertia.norm());
  CHECK(piece.points.size() == piece.nodes.size());
}

TEST_CASE("a piece without density is refused", "[cut][piece][refused]") {
  Tissue tissue(block(), below(), LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4});
  CHECK(detached_pieces(tissue).empty());
  tissue.cut(across(Eigen::Isometry3d::Identity()));
  while (tissue.process_cuts()) continue;
  CHECK_REFUSED(SetupErrorKind::bad_density, detached_pieces(tissue));
}

TEST_CASE("pieces of several densities, of quadratic elements and of moving tissue", "[cut][piece]") {
  SECTION("two regions") {
    Mesh<Tet4> mesh = block();
    mesh.region_names = {"light", "heavy"};
    for (Index e = 0; e < mesh.element_count(); ++e) {
      Vector3 middle = Vector3::Zero();
      for (int a = 0; a < 4; ++a) middle += 0.25 * mesh.position(Index{mesh.element_node(e, a)});
      mesh.regions.push_back(middle[0] > 0.5 * size[0] ? 1 : 0);
    }
    Tissue tissue(mesh, below(),
                  {{"light", LinearElastic{5e3, 0.4, 1000.0}}, {"heavy", LinearElastic{5e3, 0.4, 3000.0}}});
    tissue.cut(across(Eigen::Isometry3d::Identity()));
    while (tissue.process_cuts()) continue;
    const std::vector<DetachedPiece> pieces = detached_pieces(tissue);
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].mass == Catch::Approx(2000.0 * size[0] * size[1] * height));
    CHECK(pieces[0].centre[0] == Catch::Approx(0.625 * size[0]));  // (1 0.25 + 3 0.75) / 4
  }
  SECTION("quadratic") {
    HapticFEModel<Tet10, LinearElastic, Cuttable<Condensed<SelectiveInverse>>> tissue(promote<Tet10>(block()), below(),
                                                                                      LinearElastic{5e3, 0.4, density});
    tissue.cut(across(Eigen::Isometry3d::Identity()));
    while (tissue.process_cuts()) continue;
    const auto pieces = detached_pieces(tissue);
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].mass == Catch::Approx(density * size[0] * size[1] * height));
    CHECK(is_closed(pieces[0]));
  }
  SECTION("moving, under gravity") {
    HapticFEModel<Tet4, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>> tissue(
        block(), below().gravity({0.0, 0.0, -9.81}), NeoHookean{2e4, 0.4, density});
    tissue.cut(across(Eigen::Isometry3d::Identity()));
    for (int i = 0; i < 20; ++i) tissue.background_work();
    const auto pieces = detached_pieces(tissue);
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].mass == Catch::Approx(density * size[0] * size[1] * height));  // however it is deformed
    CHECK(is_closed(pieces[0]));
    CHECK(pieces[0].centre[2] < size[2] - 0.5 * height);
  }
}

TEST_CASE("pieces that are cut again are several, and lose what is removed", "[cut][piece]") {
  Tissue tissue(block(), below(), LinearElastic{5e3, 0.4, density});
  tissue.cut(across(Eigen::Isometry3d::Identity()));
  while (tissue.process_cuts()) continue;
  const double x = 0.5 * size[0];
  tissue.cut(BladeSweep{{x, -1, -1}, {x, 2, -1}, {x, -1, 2}, {x, 2, 2}});
  while (tissue.process_cuts()) continue;
  const auto pieces = detached_pieces(tissue);
  REQUIRE(pieces.size() >= 2);
  double mass = 0.0;
  for (const DetachedPiece& p : pieces) {
    CHECK(is_closed(p));
    CHECK(volume_of(p) * density == Catch::Approx(p.mass));
    mass += p.mass;
  }
  CHECK(mass == Catch::Approx(density * size[0] * size[1] * height));
  tissue.cut(CutOrder{.remove = pieces[0].elements, .open = {}});
  while (tissue.process_cuts()) continue;
  CHECK(detached_pieces(tissue).size() == pieces.size() - 1);
}

}  // namespace detached_piece_test
