// Selections by position.
#include "mesh_helpers.hpp"

#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/testing/random.hpp>

using namespace test;

namespace {

std::vector<NodeId> group_nodes(const Mesh<Tet4>& mesh, const char* name) {
  return mesh.find_group(name)->nodes;
}

template <Element E>
std::vector<BoundaryFace> faces_of(const Mesh<E>& mesh, const Selection& selection) {
  return detail::resolve_faces(mesh, extract_boundary<E>(mesh), selection);
}

SetupErrorKind kind_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const SetupError& error) {
    return error.kind();
  }
  return SetupErrorKind::cancelled;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("sets of points contain the points that their geometry defines", "[mesh][where]") {
  testing::Random random(11);
  const Vector3 low(-0.4, -0.2, 0.1), high(0.3, 0.6, 0.5), centre(0.1, -0.1, 0.2), normal(1.0, -2.0, 0.5);
  const auto box = where::box(low, high), sphere = where::sphere(centre, 0.5);
  const auto below = where::below(centre, normal), above = where::above(centre, normal);
  const auto capsule = where::capsule(low, high, 0.3);
  for (int k = 0; k < 2000; ++k) {
    const Vector3 x(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    const bool in_box = (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
    const bool in_sphere = (x - centre).norm() <= 0.5, is_below = (x - centre).dot(normal) <= 0.0;
    CHECK(box.contains(x) == in_box);
    CHECK(sphere.contains(x) == in_sphere);
    CHECK(below.contains(x) == is_below);
    CHECK(above.contains(x) == !is_below);  // no point of these is on the plane
    CHECK((box && sphere).contains(x) == (in_box && in_sphere));
    CHECK((box || below).contains(x) == (in_box || is_below));
    CHECK((!box).contains(x) == !in_box);
    CHECK((!(box && !sphere) || below).contains(x) == (!(in_box && !in_sphere) || is_below));
    double nearest = infinity;
    for (int i = 0; i <= 1000; ++i) nearest = std::min(nearest, (x - low - 1e-3 * i * (high - low)).norm());
    if (std::abs(nearest - 0.3) > 1e-4) CHECK(capsule.contains(x) == (nearest < 0.3));
    CHECK(where::inside([](const Vector3& p) { return p.x() > p.y(); }).contains(x) == (x.x() > x.y()));
    CHECK(sphere.relative_to({0.1, 0.2, 0.3}).contains(Vector3(x - Vector3(0.1, 0.2, 0.3)), 1e-12) ==
          sphere.contains(x, 1e-12));
  }
  CHECK(where::box({-infinity, -infinity, 0.0}, {infinity, infinity, infinity}).contains({1e9, -1e9, 0.0}));
  CHECK(where::capsule(low, low, 0.1).contains(low + Vector3(0.0, 0.09, 0.0)));  // of no length
  CHECK((box && !sphere).name() == "(" + box.name() + " and not " + sphere.name() + ")");
  CHECK(box.name() == "the box from (-0.4, -0.2, 0.1) to (0.3, 0.6, 0.5)");
}

TEST_CASE("impossible sets are refused", "[mesh][where]") {
  using K = SetupErrorKind;
  CHECK(kind_of([] { where::box({0, 0, 1}, {1, 1, 0}); }) == K::bad_argument);
  CHECK(kind_of([] { where::box({0, none, 0}, {1, 1, 1}); }) == K::bad_argument);
  CHECK(kind_of([] { where::below({0, 0, 0}, {0, 0, 0}); }) == K::bad_argument);
  CHECK(kind_of([] { where::below({none, 0, 0}); }) == K::non_finite);
  CHECK(kind_of([] { where::above({0, 0, 0}, {0, 0, infinity}); }) == K::non_finite);
  for (double radius : {0.0, -1.0, none, infinity}) {
    CHECK(kind_of([&] { where::sphere({0, 0, 0}, radius); }) == K::bad_argument);
    CHECK(kind_of([&] { where::capsule({0, 0, 0}, {1, 0, 0}, radius); }) == K::bad_argument);
  }
  CHECK(kind_of([] { where::sphere({0, none, 0}, 1.0); }) == K::non_finite);
  CHECK(kind_of([] { where::capsule({0, 0, 0}, {infinity, 0, 0}, 1.0); }) == K::non_finite);
  CHECK(kind_of([] { where::inside({}); }) == K::bad_argument);
}

TEST_CASE("a plane selects the nodes on it at any scale, position and rounding", "[mesh][where]") {
  for (double scale : {1e-6, 1.0, 1e3})
    for (double shift : {0.0, 1e3}) {
      const Vector3 by = scale * shift * Vector3(1, -0.7, 0.3);
      Mesh<Tet4> mesh = transformed(box_tet4({1, 1, 1}, {7, 7, 7}), scale, by);
      testing::Random random(3);
      for (Vector3& x : mesh.positions)
        for (int a = 0; a < 3; ++a) x[a] += 1e-9 * scale * random.uniform(-1.0, 1.0);  // as digits of a file
      const auto boundary = extract_boundary<Tet4>(mesh);
      const auto nodes = [&](const Selection& s) { return resolve_nodes(mesh, boundary, s); };
      CHECK(nodes(where::below(by)) == group_nodes(mesh, "z0"));
      CHECK(nodes(where::above(Vector3(by + Vector3(scale, 0, 0)), Vector3::UnitX())) == group_nodes(mesh, "x1"));
      CHECK(nodes(where::box(by, by + scale * Vector3(1, 0, 1))) == group_nodes(mesh, "y0"));
      CHECK(nodes(!where::below(by)).size() == 8 * 8 * 7);
      CHECK(faces_of(mesh, where::below(by)).size() == faces_of(mesh, "z0").size());
    }
}

TEST_CASE("a face is selected when all its nodes are, and only on the boundary", "[mesh][where]") {
  const auto check = [](const auto& mesh, std::size_t of_a_side) {
    CHECK(faces_of(mesh, where::box({-1, -1, 0.9}, {2, 2, 2})).size() == of_a_side);
    CHECK(faces_of(mesh, where::box({-1, -1, -1}, {2, 2, 2})).size() == 6 * of_a_side);
    CHECK(faces_of(mesh, where::inside([](const Vector3& x) { return x.z() > 0.9; })).size() == of_a_side);
    const auto p = refused(SetupErrorKind::empty_group, [&] { faces_of(mesh, where::sphere({0.5, 0.5, 0.5}, 0.3)); });
    CHECK_THAT(p.what, contains("the sphere of radius 0.3 around (0.5, 0.5, 0.5) contains no boundary face"));
  };
  check(box_tet4({1, 1, 1}, {4, 4, 4}), 32);
  check(box_tet10({1, 1, 1}, {4, 4, 4}), 32);
  check(box_hex20({1, 1, 1}, {4, 4, 4}), 16);
}

TEST_CASE("a set that selects nothing is refused with the extent of the mesh", "[mesh][where]") {
  const Mesh<Tet4> mesh = box_tet4({0.1, 0.2, 0.3}, {2, 2, 2});
  const auto boundary = extract_boundary<Tet4>(mesh);
  const auto p = refused(SetupErrorKind::empty_group, [&] {
    resolve_nodes(mesh, boundary, where::sphere({10, 0, 0}, 1));
  });
  CHECK_THAT(p.what, contains("the sphere of radius 1 around (10, 0, 0) contains no node"));
  CHECK(p.hint == "The mesh extends from (0, 0, 0) to (0.1, 0.2, 0.3) [m]");
  // A mesh that was moved to its own frame is described at its original position.
  const Selection moved = mapped(where::sphere({10, 0, 0}, 1), {}, {1, 2, 3});
  CHECK(refused(SetupErrorKind::empty_group, [&] { resolve_nodes(mesh, boundary, moved); }).hint ==
        "The mesh extends from (1, 2, 3) to (1.1, 2.2, 3.3) [m]");
}

TEST_CASE("a scene is mapped with all its sets of points", "[mesh][where]") {
  const Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {2, 2, 2});
  const auto boundary = extract_boundary<Tet4>(mesh);
  const Vector3 origin(3, -2, 7);
  const auto top = where::above(Vector3(0, 0, 8), Vector3::UnitZ());
  Scene given;
  given.fix(top).traction(top, {1, 2, 3}).pressure(top, 1.0).point_load(top, {1, 0, 0}).touch(top).render(top);
  const Scene scene = given.mapped({}, origin);
  const auto expected = group_nodes(mesh, "z1");
  CHECK(resolve_nodes(mesh, boundary, scene.prescribed()[0].where) == expected);
  CHECK(resolve_nodes(mesh, boundary, scene.tractions()[0].where) == expected);
  CHECK(resolve_nodes(mesh, boundary, scene.pressures()[0].where) == expected);
  CHECK(resolve_nodes(mesh, boundary, scene.point_loads()[0].where) == expected);
  CHECK(resolve_nodes(mesh, boundary, scene.touched()[0]) == expected);
  CHECK(resolve_nodes(mesh, boundary, scene.rendered()[0]) == expected);
  CHECK(given.group_names().empty());
}

TEST_CASE("elements are selected by their centres: each is in exactly one of a set and its complement",
          "[mesh][where]") {
  const Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {5, 5, 5});
  const auto sphere = where::sphere({0.5, 0.5, 0.5}, 0.4);
  const auto in = elements_within(mesh, sphere), out = elements_within(mesh, !sphere);
  CHECK(in.size() + out.size() == static_cast<std::size_t>(mesh.element_count()));
  CHECK(!in.empty());
  CHECK(!out.empty());
  CHECK(std::ranges::is_sorted(in));
  for (const Index e : in) {
    Vector3 centre = Vector3::Zero();
    for (int a = 0; a < 4; ++a) centre += 0.25 * mesh.position(mesh.element_node(e, a));
    CHECK((centre - Vector3(0.5, 0.5, 0.5)).norm() <= 0.4 + 1e-5);
  }
  CHECK(elements_within(mesh, where::sphere({9, 9, 9}, 1)).empty());
  CHECK(nodes_within(mesh, where::sphere({9, 9, 9}, 1)).empty());
  CHECK(nodes_within(mesh, where::below({0, 0, 0})) == group_nodes(mesh, "z0"));
  const auto count = [](Index n) { return static_cast<std::size_t>(n); };
  const MeshArrays<Tet4, double, NodeId> view(
      std::span<const double>(mesh.positions[0].data(), 3 * count(mesh.node_count())),
      std::span<const NodeId>(mesh.elements[0].data(), 4 * count(mesh.element_count())));
  CHECK(elements_within<Tet4>(view, sphere) == in);
  CHECK(nodes_within<Tet4>(view, sphere) == nodes_within(mesh, sphere));
}
