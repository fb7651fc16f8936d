// Errors after admission name nodes, elements and axes of the mesh as given.
#include <palpate/mesh/admission.hpp>

#include <algorithm>

#include "model/any_model.hpp"
#include "model/reference.hpp"

using namespace test;

namespace {

using Ids = std::vector<std::int64_t>;

void shift_nodes(Mesh<Tet4>& mesh, NodeId by) {
  for (auto& e : mesh.elements)
    for (NodeId& i : e) i += by;
  for (Group& g : mesh.groups.all()) {
    for (NodeId& i : g.nodes) i += by;
    for (auto& face : g.faces)
      for (NodeId& i : face) i += by;
  }
}

/// The mesh with an orphan node in front: admission drops it and decrements all other node ids.
Mesh<Tet4> with_orphan(Mesh<Tet4> mesh) {
  shift_nodes(mesh, 1);
  mesh.positions.insert(mesh.positions.begin(), Vector3(0.05, 0.03, 0.02));
  return mesh;
}

/// The mesh with a flat element in front: admission can drop it and decrement all other element ids.
Mesh<Tet4> with_flat_element(Mesh<Tet4> mesh) {
  const auto& e = mesh.elements.front();
  const Vector3 middle =
      0.5 * (mesh.positions[static_cast<std::size_t>(e[0])] + mesh.positions[static_cast<std::size_t>(e[1])]);
  const auto flat = static_cast<NodeId>(mesh.positions.size());
  mesh.positions.push_back(middle);
  mesh.elements.insert(mesh.elements.begin(), {e[0], e[1], e[2], flat});
  if (!mesh.regions.empty()) mesh.regions.insert(mesh.regions.begin(), mesh.regions.front());
  return mesh;
}

SetupOptions repairing() {
  SetupOptions options;
  options.admission.degenerate = Admission::repair;
  options.admission.duplicate_nodes = Admission::repair;
  options.admission.inverted = Admission::accept;
  return options;
}

std::unique_ptr<AnyModel> model_of(const Mesh<Tet4>& mesh, const Scene& scene, const SetupOptions& options = {},
                                   PolicyName policy = PolicyName::sparse_cholesky) {
  return make_model(policy, mesh, scene, LinearElastic{5e3, 0.3, 1000.0}, options);
}

/// The nodes at the given x and y coordinates.
std::vector<NodeId> edge_at(const Mesh<Tet4>& mesh, double x, double y) {
  std::vector<NodeId> nodes;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (std::abs(mesh.positions[i][0] - x) < 1e-9 && std::abs(mesh.positions[i][1] - y) < 1e-9)
      nodes.push_back(static_cast<NodeId>(i));
  return nodes;
}

/// An element that shares all its faces with other elements.
std::array<NodeId, 4> inner_element(const Mesh<Tet4>& mesh) {
  std::vector<int> outer(mesh.elements.size(), 0);
  for (const BoundaryFace& face : extract_boundary<Tet4>(mesh)) outer[static_cast<std::size_t>(face.element)] = 1;
  return mesh.elements[static_cast<std::size_t>(std::ranges::find(outer, 0) - outer.begin())];
}

}  // namespace

TEST_CASE("a free rotation is named in the frame of the mesh as given", "[model][refusals][extreme][B8]") {
  Mesh<Tet4> mesh = box_tet4({0.02, 0.02, 0.02}, {2, 2, 2});
  for (Vector3& x : mesh.positions) x += Vector3(3.0, -2.0, -0.01);
  for (const PolicyName policy : {PolicyName::condensed_inverse, PolicyName::conjugate_gradient}) {
    INFO(name(policy));
    const auto p = refusal([&] { model_of(mesh, Scene().fix(edge_at(mesh, 3.0, -2.0)).touch("z1"), {}, policy); });
    CHECK(to_string(p.kind) == "unconstrained");
    CHECK_THAT(p.what, contains("rotation about the axis (0, 0, 1) through (3, -2, 0)"));
  }
  const auto p = refusal([&] { model_of(mesh, Scene().fix(edge_at(mesh, 3.01, -1.98)).touch("z1")); });
  CHECK_THAT(p.what,
             contains("through (3.01, -1.98, 0)"));  // printed to a hundredth of the body size, not to three digits
}

TEST_CASE("the ids of an unconstrained piece are those of the mesh as given", "[model][refusals]") {
  const Mesh<Tet4> mesh = with_orphan(brick());
  const auto p = refusal([&] { model_of(mesh, Scene().touch("z1")); });
  CHECK(to_string(p.kind) == "unconstrained");
  REQUIRE(p.ids.size() == SetupProblem::max_ids);
  for (std::size_t k = 0; k < p.ids.size(); ++k) CHECK(p.ids[k] == static_cast<std::int64_t>(k) + 1);
}

TEST_CASE("conflicting conditions name the node of the mesh as given", "[model][refusals]") {
  const Mesh<Tet4> mesh = with_orphan(brick());
  const Scene scene = brick_scene();
  const auto twice = [&](NodeId node) {
    return Scene(scene).prescribe(std::vector<NodeId>{node}, {std::nullopt, 1e-3, std::nullopt});
  };
  const auto constrained = static_cast<NodeId>(5);  // node 4 of the brick, at x = 0
  REQUIRE(mesh.position(constrained)[0] == 0.0);
  const auto check = [&](const SetupProblem& p) {
    CHECK(to_string(p.kind) == "conflicting_conditions");
    CHECK(p.ids == Ids{constrained});
    CHECK(p.count == 1);
    CHECK_THAT(p.what, contains("component y"));
    CHECK_THAT(describe(p), contains("node 5"));
  };
  check(refusal([&] { model_of(mesh, twice(constrained)); }));
  SECTION("and later changes as well") {
    const auto model = model_of(mesh, scene);
    check(refusal([&] { model->set_conditions(twice(constrained)); }));
  }
}

TEST_CASE("a welded node has the lowest of its ids", "[model][refusals]") {
  Mesh<Tet4> mesh = brick();
  const auto copy = static_cast<NodeId>(mesh.positions.size());
  mesh.positions.push_back(mesh.position(8));
  auto& user = *std::ranges::find_if(mesh.elements, [](const auto& e) { return std::ranges::count(e, 8) > 0; });
  std::ranges::replace(user, NodeId{8}, copy);
  mesh = with_orphan(std::move(mesh));
  const Scene scene = Scene()
                          .fix("x0")
                          .prescribe(std::vector<NodeId>{9}, {1e-3, 0.0, 0.0})
                          .prescribe(std::vector<NodeId>{copy + 1}, {2e-3, 0.0, 0.0});
  const auto p = refusal([&] { model_of(mesh, scene, repairing()); });
  CHECK(to_string(p.kind) == "conflicting_conditions");
  CHECK(p.ids == Ids{9});
}

TEST_CASE("failed pivots name nodes of the mesh as given", "[model][refusals]") {
  // A node of the brick is duplicated, so that one of the two is merged; the last node is an accepted orphan without
  // stiffness.
  Mesh<Tet4> mesh = brick();
  shift_nodes(mesh, 1);
  constexpr NodeId twice = 9;
  mesh.positions.insert(mesh.positions.begin(), Vector3(brick().position(twice - 1)));
  auto& user = *std::ranges::find_if(mesh.elements, [&](const auto& e) { return std::ranges::count(e, twice) > 0; });
  std::ranges::replace(user, twice, NodeId{0});
  mesh.positions.emplace_back(0.05, 0.03, 0.5);
  SetupOptions options = repairing();
  options.admission.orphans = Admission::accept;
  for (const PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::condensed_inverse}) {
    INFO(name(policy));
    const auto p = refusal([&] { model_of(mesh, Scene().fix("x0").touch("z1"), options, policy); });
    INFO(describe(p));
    CHECK(to_string(p.kind) == "not_positive_definite");
    CHECK(p.ids == Ids{37});
  }
}

TEST_CASE("elements are named as in the mesh as given", "[model][refusals][extreme][B4]") {
  SECTION("inverted ones that were accepted") {
    Mesh<Tet4> mesh = brick();
    std::swap(mesh.elements[7][0], mesh.elements[7][1]);
    mesh = with_flat_element(std::move(mesh));
    const auto p = refusal([&] { model_of(mesh, Scene().fix("x0").touch("z1"), repairing()); });
    CHECK(to_string(p.kind) == "inverted_element");
    CHECK(p.ids == Ids{8});
    CHECK_THAT(describe(p), contains("element 8"));
  }
  SECTION("faces of three elements") {
    Mesh<Tet4> mesh = brick();
    auto third = inner_element(mesh);  // shares all its faces
    third[3] = static_cast<NodeId>(mesh.positions.size());
    mesh.positions.emplace_back(0.5, 0.5, 0.5);
    mesh.elements.push_back(third);
    const auto plain = refusal([&] { model_of(mesh, Scene().fix("x0").touch("z1"), repairing()); });
    REQUIRE(to_string(plain.kind) == "non_manifold");
    const auto shifted =
        refusal([&] { model_of(with_flat_element(mesh), Scene().fix("x0").touch("z1"), repairing()); });
    REQUIRE(shifted.ids.size() == plain.ids.size());
    for (std::size_t k = 0; k < plain.ids.size(); ++k) CHECK(shifted.ids[k] == plain.ids[k] + 1);
  }
}

TEST_CASE("errors of other meshes inside a progress callback keep their own ids", "[model][refusals]") {
  const Mesh<Tet4> mesh = with_orphan(brick());
  Ids seen;
  SetupOptions options;
  options.progress = [&](const Progress& progress) {
    if (progress.stage == "factorisation" || progress.stage == "checks") {
      AdmissionPolicy strict;
      strict.orphans = Admission::refuse;
      Mesh<Tet4> other = brick();
      other.positions.emplace_back(0.05, 0.03, 0.5);
      const auto orphan = static_cast<NodeId>(other.positions.size()) - 2;  // in this mesh, not in the one being set up
      std::swap(other.positions[static_cast<std::size_t>(orphan)], other.positions.back());
      for (auto& e : other.elements) std::ranges::replace(e, orphan, orphan + 1);
      other.groups = {};
      seen = refusal([&] { admit<Tet4>(other, strict); }).ids;
    }
    return true;
  };
  model_of(mesh, brick_scene(), options);
  CHECK(seen == Ids{35});
}
