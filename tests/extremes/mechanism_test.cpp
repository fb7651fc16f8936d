// Connected bodies whose parts can still move: hinges, spherical joints, chains and linkages of blocks.
#include <palpate/mesh/detail/mechanisms.hpp>

#include "extremes/verdict.hpp"

#include <map>

using namespace test;

namespace {

const LinearElastic material{5e3, 0.3, 1000.0};
/// Unit cubes of n^3 cells; nodes at the same place are merged. `cube_of` is the cube of each element.
struct Blocks {
  Mesh<Tet4> mesh;
  std::vector<std::size_t> cube_of;

  Blocks(const std::vector<Vector3>& corners, int n) {
    const Mesh<Tet4> one = box_tet4({1, 1, 1}, {n, n, n});
    for (std::size_t k = 0; k < corners.size(); ++k) {
      std::vector<NodeId> to;
      for (const Vector3& x : one.positions) {
        const Vector3 place = x + corners[k];
        const auto same =
            std::ranges::find_if(mesh.positions, [&](const Vector3& y) { return (place - y).norm() < 1e-9; });
        to.push_back(static_cast<NodeId>(same - mesh.positions.begin()));
        if (same == mesh.positions.end()) mesh.positions.push_back(place);
      }
      for (auto element : one.elements) {
        for (NodeId& i : element) i = to[static_cast<std::size_t>(i)];
        mesh.elements.push_back(element);
        cube_of.push_back(k);
      }
    }
  }
  /// The nodes of one cube that satisfy `wanted`.
  template <class Wanted>
  std::vector<NodeId> nodes(std::size_t cube, Wanted wanted) const {
    std::vector<NodeId> all;
    for (std::size_t e = 0; e < cube_of.size(); ++e)
      if (cube_of[e] == cube)
        for (const NodeId i : mesh.elements[e])
          if (wanted(mesh.position(i))) all.push_back(i);
    detail::sort_unique(all);
    return all;
  }
};

/// Cubes, their supports, and the number of motions of the first part that can move; 0 when none can.
struct Linkage {
  const char* name;
  std::vector<Vector3> corners;
  std::vector<std::size_t> fixed;  ///< cubes fixed at their lowest face
  int motions;
};

const std::vector<Linkage> linkages{
    {"a hinge", {{0, 0, 0}, {1, 0, 1}}, {0}, 1},
    {"half a hinge", {{0, 0, 0}, {1, 0.5, 1}}, {0}, 1},
    {"a spherical joint", {{0, 0, 0}, {1, 1, 1}}, {0}, 3},
    {"two hinges in a row", {{0, 0, 0}, {1, 0, 1}, {2, 0, 2}}, {0}, 1},
    {"a hinge and a spherical joint in a row", {{0, 0, 0}, {1, 0, 1}, {2, 1, 2}}, {0}, 1},
    {"four bars", {{0, 0, 0}, {1, 0, 1}, {2, 0, 0}, {1, 0, -1}}, {0}, 1},
    {"a cube on two spherical joints", {{0, 0, 0}, {1, 1, 1}, {2, 2, 0}}, {0, 2}, 1},
};
/// No part of these can move: hinges that are not parallel, spherical joints that are not collinear.
const std::vector<Linkage> constrained_linkages{
    {"two hinges across", {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}}, {0, 2}, 0},
    {"three hinges in a corner", {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}}, {0}, 0},
    {"a hinge and a spherical joint off its axis", {{0, 0, 0}, {1, 0, 1}, {2, 1, 0}}, {0, 2}, 0},
};

Scene scene_of(const Blocks& b, const Linkage& l) {
  Scene scene;
  for (const std::size_t cube : l.fixed)
    scene.fix(b.nodes(cube, [&](const Vector3& x) { return x[2] < l.corners[cube][2] + 1e-9; }));
  return scene;
}

/// The mesh rotated, scaled and shifted.
Mesh<Tet4> placed(Mesh<Tet4> mesh, std::uint64_t seed, double scale) {
  testing::Random random(seed);
  const Matrix3 turn = seed == 0 ? Matrix3(Matrix3::Identity()) : testing::random_rotation(random);
  for (Vector3& x : mesh.positions) x = scale * (turn * x + Vector3(0.3, -0.7, 0.2) * static_cast<double>(seed));
  return mesh;
}

/// Touched: the top of the first cube, of the last, the whole surface, nothing.
std::vector<Scene> touched_scenes(const Blocks& b, const Linkage& l) {
  const Scene scene = scene_of(b, l);
  const auto top = [&](std::size_t cube) {
    return b.nodes(cube, [&](const Vector3& x) { return x[2] > l.corners[cube][2] + 1.0 - 1e-9; });
  };
  return {Scene(scene).touch(top(0)), Scene(scene).touch(top(l.corners.size() - 1)), Scene(scene).touch("surface"),
          scene};
}

template <class Visit>
void for_each_case(const std::vector<Linkage>& all, Visit visit) {
  for (const Linkage& l : all)
    for (const int n : {1, 2, 3}) {
      if (n % 2 == 1 && std::string(l.name) == "half a hinge") continue;  // no coincident nodes
      const Blocks b(l.corners, n);
      const std::vector<Scene> scenes = touched_scenes(b, l);
      for (const auto& [seed, scale] : {std::pair{0, 1.0}, {1, 1e-3}, {2, 1e3}}) {
        const Mesh<Tet4> mesh = placed(b.mesh, static_cast<std::uint64_t>(seed), scale);
        for (std::size_t s = 0; s < scenes.size(); ++s) {
          INFO(l.name << ", " << n << " cells, orientation " << seed << ", scale " << scale << ", scene " << s);
          visit(l, b, mesh, scenes[s]);
        }
      }
    }
}

}  // namespace

TEST_CASE("mechanisms are refused before any factorisation, with part, joint and motion", "[extreme][B7][B8]") {
  std::map<std::string, int> count;
  for_each_case(linkages, [&](const Linkage& l, const Blocks& b, const Mesh<Tet4>& mesh, const Scene& scene) {
    REQUIRE(detail::connected_components<Tet4>(mesh).count == 1);
    REQUIRE(detail::face_connected_parts(mesh_ref(mesh)).count == static_cast<Index>(l.corners.size()));
    for (const PolicyName policy : extreme_policies) {
      INFO(name(policy));
      const SetupProblem p = refusal([&] { make_model(policy, mesh, scene, material); });
      INFO(describe(p));
      ++count[std::string(to_string(p.kind)) + (p.ids.empty() ? ", no ids" : "")];
      CHECK(to_string(p.kind) == "unconstrained");
      CHECK(p.value == l.motions);
      CHECK(p.ids_of == SetupIds::nodes);
      CHECK(!p.ids.empty());
      CHECK_THAT(p.what, contains(" part of "));
      for (const std::int64_t i : p.ids) {  // nodes that two cubes share
        int users = 0;
        for (std::size_t cube = 0; cube < l.corners.size(); ++cube)
          users += !b.nodes(cube, [&](const Vector3& x) { return x == b.mesh.position(i); }).empty();
        CHECK(users == 2);
      }
    }
  });
  for (const auto& [kind, n] : count) UNSCOPED_INFO(kind << ": " << n);
  CHECK(count.size() == 1);
}

TEST_CASE("joints that constrain all motions are not mechanisms", "[extreme][B7][B8]") {
  for_each_case(constrained_linkages, [&](const Linkage&, const Blocks&, const Mesh<Tet4>& mesh, const Scene& scene) {
    for (const PolicyName policy : extreme_policies) {
      INFO(name(policy));
      CHECK_NOTHROW(make_model(policy, mesh, scene, material));
    }
  });
}

TEST_CASE("the motion of a mechanism is named in the frame of the mesh as given", "[extreme][B7]") {
  const Blocks b(linkages[0].corners, 2);
  Mesh<Tet4> mesh = b.mesh;
  const Vector3 shift(5, 0, -2);
  for (Vector3& x : mesh.positions) x += shift;
  const SetupProblem p = refusal(
      [&] { make_model(PolicyName::condensed_inverse, mesh, scene_of(b, linkages[0]).touch("surface"), material); });
  CHECK_THAT(p.what, contains("a part of 40 elements shares no face with others, only 3 nodes"));
  CHECK_THAT(p.what, contains("1 free rigid motion: rotation about the axis (0, 1, 0) through (6, "));
  CHECK(p.count == 3);
}

TEST_CASE("a chain of many links", "[extreme][B7]") {
  std::vector<Vector3> corners;
  for (int k = 0; k < 60; ++k) corners.emplace_back(k, 0, k % 2);
  const Blocks chain(corners, 1);
  std::vector<std::uint8_t> constrained(chain.mesh.positions.size(), 0);
  const auto hold = [&](std::size_t cube) {
    for (const NodeId i : chain.nodes(cube, [](const Vector3&) { return true; }))
      constrained[static_cast<std::size_t>(i)] = 7;
  };
  const auto found = [&] { return detail::find_mechanism(mesh_ref(chain.mesh), constrained).has_value(); };
  hold(0);
  CHECK(found());
  hold(59);
  CHECK(found());
  for (std::size_t cube = 2; cube < 59; cube += 2) hold(cube);  // every other one: the others have two hinges each
  CHECK_FALSE(found());
}

TEST_CASE("a chain too long for the geometric check is refused by the factorisation", "[extreme][B7]") {
  std::vector<Vector3> corners;
  for (int k = 0; k < 170; ++k) corners.emplace_back(k, 0, k % 2);
  const Blocks chain(corners, 1);
  const Mesh<Tet4> mesh = placed(chain.mesh, 1, 0.01);
  for (const Scene& scene : touched_scenes(chain, {"a long chain", corners, {0}, 0}))
    for (const PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::condensed_inverse})
      CHECK_REFUSED(SetupErrorKind::not_positive_definite, make_model(policy, mesh, scene, material));
}

TEST_CASE("supports on a line or at a point leave motions of the whole body", "[extreme][B8]") {
  for (const auto& [seed, scale] : {std::pair{0, 1.0}, {1, 1e-3}, {2, 1e3}})
    for (const int n : {1, 3}) {
      const Blocks b({{0, 0, 0}}, n);
      const Mesh<Tet4> mesh = placed(b.mesh, static_cast<std::uint64_t>(seed), scale);
      const auto point = b.nodes(0, [](const Vector3& x) { return x.norm() < 1e-9; });
      const auto line = b.nodes(0, [](const Vector3& x) { return x.tail<2>().norm() < 1e-9; });
      for (const PolicyName policy : extreme_policies)
        for (const char* touched : {"surface", ""})
          for (const auto& [constrained, motions] : {std::pair{point, 3.0}, {line, 1.0}}) {
            Scene scene = Scene().fix(constrained);
            if (*touched != '\0') scene.touch(touched);
            const SetupProblem p = refusal([&] { make_model(policy, mesh, scene, material); });
            CHECK(to_string(p.kind) == "unconstrained");
            CHECK(p.value == motions);
            CHECK(!p.ids.empty());
          }
    }
}
