// Tests of the bodies and paths of scenes: their meshes, places, tools and states under every change.
#include "built.hpp"
#include "catch.hpp"

#include <palpate/contact/detail/triangle.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using palpate::Matrix3;
using palpate::Vector3;

namespace {

cross::Scene scene_of(const std::string& body, const std::string& element) {
  cross::Scene scene;
  scene.body = body;
  scene.element = element;
  scene.cells_x = 6, scene.cells_y = 4, scene.cells_z = 3;
  if (body == "plate" || body == "lobe") scene.cells_x = 7, scene.cells_z = 2;
  if (!cross::has_hexahedra(body)) scene.cells_x = 3;
  return scene;
}

std::vector<cross::Scene> all_scenes() {
  std::vector<cross::Scene> scenes;
  for (const std::string& body : cross::words_of("body"))
    for (const char* element : {"tet4", "hex8"}) {
      const cross::Scene scene = scene_of(body, element);
      if (!cross::is_hexahedral(scene) || cross::has_hexahedra(body)) scenes.push_back(scene);
    }
  return scenes;
}

Matrix3 some_rotation() {
  palpate::testing::Random random(3);
  return palpate::testing::random_rotation(random);
}

std::vector<cross::Change> all_changes() {
  std::vector<cross::Change> changes(6);
  changes[1].linear = some_rotation();
  changes[2].linear = Vector3(-1.0, 1.0, 1.0).asDiagonal() * some_rotation();
  changes[3].renumbered = true;
  changes[4].scale = 100.0;
  changes[5] = {changes[2].linear, Vector3(0.3, -2.0, 1.0), 0.1, true, true, false, 0.0};
  return changes;
}

/// Calls f with the mesh of a body, of either kind of element.
template <class F>
auto with_mesh(const cross::Scene& scene, const cross::Body& body, F&& f) {
  return cross::is_hexahedral(scene) ? f(body.hexahedra) : f(body.tetrahedra);
}

struct Shape {
  double volume = 0.0, least_volume = palpate::infinity, least_quality = 1.0;
};

Shape shape_of(const cross::Scene& scene, const cross::Body& body) {
  return with_mesh(scene, body, []<class E>(const palpate::Mesh<E>& mesh) {
    Shape shape;
    for (palpate::Index e = 0; e < mesh.element_count(); ++e) {
      const palpate::ElementShape one = palpate::element_shape<E>(palpate::element_nodes<E>(mesh, e));
      shape.volume += one.volume;
      shape.least_volume = std::min(shape.least_volume, one.relative_volume);
      shape.least_quality = std::min(shape.least_quality, one.quality);
    }
    return shape;
  });
}

double distance_to(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const palpate::detail::TrianglePoint closest = palpate::detail::closest_point(p, a, b, c);
  return (p - closest.weights[0] * a - closest.weights[1] * b - closest.weights[2] * c).norm();
}

/// Distance from a point to the faces of the touchable group.
double distance_to_touchable(const cross::Scene& scene, const cross::Body& body, const Vector3& p) {
  return with_mesh(scene, body, [&](const auto& mesh) {
    double least = palpate::infinity;
    for (const auto& face : mesh.find_group("touchable")->faces)
      for (std::size_t i = 2; i < face.size(); ++i)
        least =
            std::min(least, distance_to(p, mesh.position(face[0]), mesh.position(face[i - 1]), mesh.position(face[i])));
    return least;
  });
}

bool is_flat(const cross::Scene& scene) {
  return scene.body == "block" || scene.body == "plate" || scene.body == "lobe";
}

}  // namespace

TEST_CASE("cross: elements of every body have positive volumes under every change") {
  for (cross::Scene scene : all_scenes()) {
    const double volume = shape_of(scene, cross::make_body(scene)).volume;
    for (const double jitter : {0.0, 0.3}) {
      scene.jitter = jitter;
      const double quality = shape_of(scene, cross::make_body(scene)).least_quality;
      for (const cross::Change& change : all_changes()) {
        INFO(scene.body << " " << scene.element << " jitter " << jitter << " scale " << change.scale);
        const cross::Body body = cross::make_body(scene, change);
        const Shape shape = shape_of(scene, body);
        CHECK(shape.least_volume > 0.0);
        CHECK(shape.least_quality > 0.049);
        CHECK_THAT(shape.least_quality, WithinRel(quality, 1e-6));
        CHECK_THAT(shape.volume, WithinRel(volume * std::pow(change.scale, 3), 1e-10));
        CHECK_THAT(body.density * std::pow(change.scale, 2), WithinRel(scene.density, 1e-12));
      }
    }
  }
}

TEST_CASE("cross: bodies of few cells are not inverted either") {
  for (cross::Scene scene : all_scenes())
    for (int x = 1; x <= 3; ++x)
      for (int z = 1; z <= 6; z += 2) {
        scene.cells_x = x, scene.cells_y = 2, scene.cells_z = z;
        INFO(scene.body << " " << scene.element << " " << x << " " << z);
        CHECK(shape_of(scene, cross::make_body(scene)).least_quality > 0.05);
      }
}

TEST_CASE("cross: places are on the touchable surface, and tangents across normals") {
  std::vector<cross::Scene> scenes = all_scenes();
  for (std::size_t i = 0, count = scenes.size(); i < count; ++i)
    if (!cross::has_hexahedra(scenes[i].body)) scenes.push_back(scenes[i]), scenes.back().cells_x = 2;
  for (cross::Scene scene : scenes)
    for (const char* touched : {"top", "surface"})
      for (const bool opposite : {false, true}) {
        scene.touched = touched;
        scene.support = opposite ? "end" : "bottom";
        const cross::Body body = cross::make_body(scene);
        const double allowed = is_flat(scene) ? 1e-9 * body.size : 0.2 * scene.edge;
        for (const double u : {0.0, 0.5, 0.8, 1.0})
          for (const double v : {0.0, 0.5, 1.0}) {
            INFO(scene.body << " " << scene.element << " " << touched << " " << opposite << " " << u << " " << v);
            const cross::Place place = cross::place_of(scene, u, v, opposite);
            CHECK(distance_to_touchable(scene, body, place.point) < allowed);
            CHECK_THAT(place.normal.norm(), WithinAbs(1.0, 1e-12));
            CHECK_THAT(place.along.norm(), WithinAbs(1.0, 1e-12));
            CHECK_THAT(place.normal.dot(place.along), WithinAbs(0.0, 1e-9));
          }
      }
}

TEST_CASE("cross: the other side has another normal") {
  for (cross::Scene scene : all_scenes()) {
    scene.touched = "surface", scene.support = "end";
    const cross::Place one = cross::place_of(scene, 0.3, 0.8, false), other = cross::place_of(scene, 0.3, 0.8, true);
    INFO(scene.body);
    CHECK(one.normal.dot(other.normal) < 0.0);
    CHECK((one.point - other.point).norm() > scene.edge);
  }
}

TEST_CASE("cross: groups list outward faces, under a reflection too") {
  for (const cross::Scene& scene : all_scenes())
    for (const cross::Change& change : all_changes())
      with_mesh(scene, cross::make_body(scene, change), [&]<class E>(const palpate::Mesh<E>& mesh) {
        INFO(scene.body << " " << scene.element);
        const auto boundary = palpate::extract_boundary<E>(mesh);
        const palpate::Group& group = *mesh.find_group("touchable");
        const auto faces = palpate::detail::resolve_faces<E>(mesh, boundary, std::string("touchable"));
        CHECK(faces.size() == group.faces.size());
        CHECK(palpate::resolve_nodes<E>(mesh, boundary, std::string("support")).size() > 2);
        for (const auto& face : group.faces) {
          const auto matches = [&](const palpate::BoundaryFace& f) {
            auto rotated = face;
            const auto start = std::ranges::find(rotated, f.nodes[0]);
            if (start == rotated.end()) return false;
            std::rotate(rotated.begin(), start, rotated.end());
            return std::ranges::equal(rotated, f.nodes);
          };
          CHECK(std::ranges::any_of(faces, matches));
        }
      });
}

TEST_CASE("cross: slivers are almost flat, and not inverted") {
  for (cross::Scene scene : all_scenes()) {
    if (cross::is_hexahedral(scene)) continue;
    for (const double jitter : {0.0, 0.2}) {
      scene.slivers = 2, scene.jitter = jitter;
      const Shape shape = shape_of(scene, cross::make_body(scene));
      INFO(scene.body << " jitter " << jitter);
      CHECK(shape.least_quality < 0.06);
      CHECK(shape.least_quality > 0.03);
    }
  }
}

TEST_CASE("cross: regions are named, and none is empty") {
  for (cross::Scene scene : all_scenes())
    for (const std::string& regions : cross::words_of("regions"))
      for (const bool split : {false, true}) {
        scene.regions = regions, scene.contrast = 10.0;
        cross::Change change;
        change.split = split;
        const cross::Body body = cross::make_body(scene, change);
        const bool one = regions == "one";
        INFO(scene.body << " " << scene.element << " " << regions);
        CHECK(body.moduli.size() == (one && !split ? 1u : 2u));
        CHECK_THAT(body.moduli.back(), WithinRel(scene.youngs_modulus * (one ? 1.0 : scene.contrast), 1e-12));
        with_mesh(scene, body, [&](const auto& mesh) {
          CHECK(mesh.region_names.size() == body.moduli.size());
          CHECK(mesh.regions.size() == mesh.elements.size());
          CHECK(std::ranges::count(mesh.regions, 0) > 0);
          CHECK((std::ranges::count(mesh.regions, 1) > 0) == (body.moduli.size() == 2));
        });
      }
}

TEST_CASE("cross: the same seed gives the same body") {
  cross::Scene scene = scene_of("block", "tet4");
  scene.jitter = 0.2, scene.slivers = 1;
  const cross::Body one = cross::make_body(scene);
  CHECK((one.tetrahedra.positions == cross::make_body(scene).tetrahedra.positions));
  scene.seed = 2;
  CHECK((one.tetrahedra.positions != cross::make_body(scene).tetrahedra.positions));
}

TEST_CASE("cross: loads follow a change") {
  cross::Scene scene = scene_of("block", "tet4");
  scene.load_size = 0.1;
  const cross::Change change = all_changes().back();
  const auto both = [&](const std::string& load) {
    scene.load = load;
    return std::pair{cross::make_body(scene), cross::make_body(scene, change)};
  };
  const auto [heavy, heavy_changed] = both("gravity");
  CHECK((heavy_changed.conditions.gravity() - change.scale * (change.linear * heavy.conditions.gravity())).norm() <
        1e-12);
  CHECK_THAT(heavy.conditions.gravity().norm() * heavy.density * heavy.size,
             WithinRel(0.1 * scene.youngs_modulus, 1e-12));
  const auto [point, point_changed] = both("point");
  const auto node = [](const cross::Body& body) {
    return body.tetrahedra.position(
        std::get<std::vector<palpate::NodeId>>(body.conditions.point_loads().at(0).where).at(0));
  };
  CHECK((node(point_changed) - change(node(point))).norm() < 1e-12);
  scene.support_moves = 0.5;
  const auto values = both("none").second.conditions.prescribed().at(0).values;
  const Vector3 moved(*values[0], *values[1], *values[2]);
  CHECK((moved - 0.5 * scene.edge * change.scale * change.linear.col(0)).norm() < 1e-12);
}

TEST_CASE("cross: paths follow a change and a pose") {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = some_rotation().transpose();
  pose.translation() = Vector3(1.0, 2.0, 3.0);
  const Eigen::Isometry3d none = Eigen::Isometry3d::Identity();
  cross::Scene scene = scene_of("organ", "tet4");
  scene.tools[0].u = 0.3, scene.tools[0].travel = 1.0;
  for (const std::string& path : cross::words_of("path"))
    for (const std::string& kind : cross::words_of("kind"))
      for (const cross::Change& change : all_changes())
        for (int tick = 0; tick < scene.ticks; tick += 7) {
          scene.tools[0].path = path, scene.tools[0].kind = kind;
          const palpate::ToolState plain = cross::state_of(scene, 0, tick, none);
          const palpate::ToolState moved = cross::state_of(scene, 0, tick, pose, change);
          CHECK((moved.position - pose * change(plain.position)).norm() < 1e-12);
          const auto rotation = [](const palpate::ToolState& s) {
            return Eigen::Quaterniond(s.orientation[0], s.orientation[1], s.orientation[2], s.orientation[3])
                .toRotationMatrix();
          };
          const Vector3 axis(0.2, -0.5, 0.7);  // of the tool's own frame
          CHECK((rotation(moved) * change.direction(axis) - pose.linear() * change.direction(rotation(plain) * axis))
                    .norm() < 1e-12);
          CHECK_THAT(cross::depth_of(scene, 0, tick, change),
                     WithinAbs(change.scale * cross::depth_of(scene, 0, tick), 1e-12));
        }
}

TEST_CASE("cross: a pause inserts ticks at the beginning of the second phase") {
  cross::Scene scene;
  cross::Change change;
  change.pause = 0.05;
  CHECK(cross::ticks_of(scene, change) == 350);
  const Eigen::Isometry3d none = Eigen::Isometry3d::Identity();
  for (const std::string& path : cross::words_of("path"))
    for (int tick = 0; tick < scene.ticks; ++tick) {
      scene.tools[0].path = path, scene.tools[0].travel = 1.0, scene.tools[0].grasps = true;
      const int later = tick < cross::first_hold(scene) ? tick : tick + 50;
      const palpate::ToolState plain = cross::state_of(scene, 0, tick, none);
      const palpate::ToolState paused = cross::state_of(scene, 0, later, none, change);
      CHECK((plain.position - paused.position).norm() < 1e-15);
      CHECK(plain.orientation == paused.orientation);
      CHECK(plain.valid == paused.valid);
      CHECK(plain.buttons == paused.buttons);
    }
}

TEST_CASE("cross: a path reaches its depth, is smooth, and ends outside") {
  cross::Scene scene;
  const double radius = scene.tools[0].radius;
  CHECK_THAT(cross::depth_of(scene, 0, 0), WithinAbs(-0.5 * radius, 1e-12));
  CHECK_THAT(cross::depth_of(scene, 0, cross::first_hold(scene)), WithinAbs(0.25 * radius, 1e-12));
  CHECK_THAT(cross::depth_of(scene, 0, cross::last_hold(scene)), WithinAbs(0.25 * radius, 1e-12));
  CHECK_THAT(cross::depth_of(scene, 0, 285), WithinAbs(-0.5 * radius, 1e-12));
  for (int tick = 1; tick < scene.ticks; ++tick)
    CHECK(std::abs(cross::depth_of(scene, 0, tick) - cross::depth_of(scene, 0, tick - 1)) < 0.02 * radius);
  const cross::Place place = cross::place_of(scene, 0.5, 0.5, false);
  const auto middle = cross::state_of(scene, 0, 150, Eigen::Isometry3d::Identity());
  CHECK((middle.position - place.point - 0.75 * radius * place.normal).norm() < 1e-12);
}

TEST_CASE("cross: tools of every kind are valid and follow a change") {
  cross::Scene scene = scene_of("dome", "tet4");
  scene.tools.clear();
  for (const std::string& kind : cross::words_of("kind")) {
    scene.tools.emplace_back();
    scene.tools.back().kind = kind, scene.tools.back().u = 0.2;
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = some_rotation();
  for (const cross::Change& change : all_changes()) {
    const palpate::ToolList tools = cross::tools_of(scene, change, pose);
    REQUIRE(tools.size() == 4);
    const double radius = change.scale * scene.tools[0].radius;
    const Vector3 along = change.direction(cross::place_of(scene, 0.2, 0.5, false).along);
    std::get<palpate::SphereTool>(tools[0]).require_valid();
    std::get<palpate::CapsuleTool>(tools[1]).require_valid();
    std::get<palpate::BladeTool>(tools[3]).require_valid();
    CHECK((std::get<palpate::CapsuleTool>(tools[1]).axis - along).norm() < 1e-12);
    CHECK_THAT(std::get<palpate::ConvexTool>(tools[2]).hull().extent(), WithinRel(std::sqrt(3.25) * radius, 1e-9));
    CHECK((std::get<palpate::BladeTool>(tools[3]).edge - 4.0 * radius * (pose.linear() * along)).norm() < 1e-9);
  }
}

TEST_CASE("cross: the text of a scene can be read back") {
  cross::Scene scene = scene_of("tube", "hex8");
  scene.poisson_ratio = 0.1 + 0.2, scene.load = "point", scene.inertia = false, scene.seed = ~std::uint64_t{0};
  scene.tools.emplace_back();
  scene.tools[1].kind = "blade", scene.tools[1].opposite = true, scene.tools[1].u = 1.0 / 3.0;
  for (const cross::Scene& one : {scene, cross::Scene{}}) {
    std::istringstream text(cross::to_text(one));
    CHECK(cross::from_text(text) == one);
  }
}
