// Extremes of mesh and support: refused, flagged, or right.
#include <palpate/model/static/detail/statics.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "extremes/verdict.hpp"
#include "mesh/two_cubes.hpp"

using namespace test;

namespace {

const LinearElastic plain{5e3, 0.3, 1000.0};

/// The brick with the first layer of cells, or the last one, flattened to a fraction of its height.
Mesh<Tet4> with_slivers(double height) {
  const double h = 0.02 * height;
  return box_tet4({0.0, 0.03, 0.06, 0.1}, {0.0, 0.03, 0.06}, {0.0, 0.02, 0.02 + h});
}

/// The brick with one node moved towards the opposite face of one of its elements.
Mesh<Tet4> with_one_sliver(double height) {
  Mesh<Tet4> mesh = two_cubes();
  const NodeId apex = mesh.elements[8][0];  // node 11, a corner of one element only
  const Vector3 a = mesh.positions[9], b = mesh.positions[7], c = mesh.positions[10];
  const Vector3 centre = (a + b + c) / 3.0;
  mesh.positions[static_cast<std::size_t>(apex)] =
      centre + height * (mesh.positions[static_cast<std::size_t>(apex)] - centre);
  return mesh;
}

Mesh<Tet4> rotated(Mesh<Tet4> mesh) {
  testing::Random random(53);
  const Matrix3 r = testing::random_rotation(random);
  for (Vector3& x : mesh.positions) x = r * x;
  return mesh;
}

/// Two tetrahedra with `shared` nodes in common: 1 a spherical joint, 2 a hinge, 3 a face.
Mesh<Tet4> joined(int shared) {
  Mesh<Tet4> mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.3, 0.3, 1}};
  mesh.elements = {{0, 1, 2, 3}};
  Mesh<Tet4>::Connectivity second{0, 0, 0, 0};
  const std::array<Vector3, 4> mirrored{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.2, 1, 0), Vector3(0.3, 0.3, -1)};
  for (int a = 0; a < 4; ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (a < shared) {
      second[i] = static_cast<NodeId>(a);
      continue;
    }
    second[i] = static_cast<NodeId>(mesh.positions.size());
    mesh.positions.push_back(mirrored[i] + (a < 3 ? Vector3(0.1 * a, -0.3, -0.5) : Vector3(0, 0, 0)));
  }
  Tet4Nodes<double> x, g;
  for (int a = 0; a < 4; ++a)
    x.row(a) = mesh.positions[static_cast<std::size_t>(second[static_cast<std::size_t>(a)])].transpose();
  if (closed_form_gradients<double>(x, g) < 0.0) std::swap(second[2], second[3]);
  mesh.elements.push_back(second);
  return mesh;
}

/// Two bricks that share only the nodes of one edge along y, or one corner.
Mesh<Tet4> hinged_bricks(bool edge) {
  const Mesh<Tet4> one = brick();
  const Vector3 shift(0.1, edge ? 0.0 : 0.06, 0.04);
  Mesh<Tet4> mesh = one;
  std::vector<NodeId> to;
  for (const Vector3& x : one.positions) {
    const auto there = [&](const Vector3& p) { return (p - x - shift).norm() < 1e-9; };
    const auto joint = std::ranges::find_if(one.positions, there);
    if (joint != one.positions.end()) {
      to.push_back(static_cast<NodeId>(joint - one.positions.begin()));
      continue;
    }
    to.push_back(static_cast<NodeId>(mesh.positions.size()));
    mesh.positions.push_back(x + shift);
  }
  for (auto e : one.elements) {
    for (NodeId& i : e) i = to[static_cast<std::size_t>(i)];
    mesh.elements.push_back(e);
  }
  return mesh;
}

void check_refused_by_all(const Mesh<Tet4>& mesh, const Scene& scene) {
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const SetupProblem p = refusal([&] { make_model(policy, mesh, scene, plain); });
    const std::string kind(to_string(p.kind));
    INFO(describe(p));
    CHECK((kind == "unconstrained" || kind == "not_positive_definite" || kind == "ill_conditioned" ||
           kind == "not_converged"));
  }
}

}  // namespace

TEST_CASE("degenerate elements never become a model", "[extreme][B3]") {
  const auto kind = [](Mesh<Tet4> mesh) {
    return to_string(
        refusal([&] { make_model(PolicyName::sparse_cholesky, mesh, Scene().fix("fixed").touch("end"), plain); }).kind);
  };
  Mesh<Tet4> flat = two_cubes();
  flat.positions[11] = (flat.positions[9] + flat.positions[7] + flat.positions[10]) / 3.0;
  CHECK(kind(flat) == "degenerate_element");
  Mesh<Tet4> twin = two_cubes();
  twin.positions[11] = twin.positions[10];
  CHECK(kind(twin) == "duplicate_node");
  Mesh<Tet4> repeated = two_cubes();
  repeated.elements[9][1] = repeated.elements[9][0];
  CHECK(kind(repeated) == "degenerate_element");
  Mesh<Tet4> nan = two_cubes();
  nan.positions[5][1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(kind(nan) == "non_finite");
  Mesh<Tet4> outside = two_cubes();
  outside.elements[3][2] = 12;
  CHECK(kind(outside) == "index_out_of_range");
  Mesh<Tet4> inside_out = two_cubes();
  std::swap(inside_out.elements[2][0], inside_out.elements[2][1]);
  CHECK(kind(inside_out) == "inverted_element");
}

TEST_CASE("one sliver, and a layer of slivers", "[extreme][B5]") {
  for (double height : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-11}) {
    const auto expect = [&](PolicyName policy, const Outcome& o) {
      if (height >= 1e-3 && (policy == PolicyName::sparse_cholesky || policy == PolicyName::condensed_inverse))
        CHECK((o.verdict == Verdict::right || o.verdict == Verdict::flagged));
      if (height <= 1e-11) CHECK(o.verdict == Verdict::refused);
    };
    judge_all("one sliver " + number(height), with_one_sliver(height), {plain},
              Scene().fix("fixed").touch("end").point_load("end", {1, 2, -3}), expect);
    judge_all("layer " + number(height), with_slivers(height), {plain}, brick_scene().traction("x1", {1, 0.5, -2}),
              expect);
  }
}

TEST_CASE("slivers are flagged", "[extreme][B5]") {
  for (double height : {1e-2, 1e-3, 1e-4}) {
    const auto model =
        make_model(PolicyName::sparse_cholesky, with_one_sliver(height), Scene().fix("fixed").touch("end"), plain);
    CHECK(model->report().has(SetupFlag::poor_quality));
    CHECK(model->report().worst_quality < 0.1);
  }
}

TEST_CASE("an orphan node does not reach the solver", "[extreme][B6]") {
  Mesh<Tet4> mesh = brick();
  mesh.positions.emplace_back(0.05, 0.05, 0.05);
  SetupOptions accept;
  accept.admission.orphans = Admission::accept;  // gives the stiffness a zero row
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    CHECK_NOTHROW(make_model(policy, mesh, brick_scene(), plain));
    CHECK_THROWS_AS(make_model(policy, mesh, brick_scene(), plain, accept), SetupError);
  }
}

TEST_CASE("bodies without sufficient supports are refused", "[extreme][B7][B8]") {
  for (const Scene& scene : {Scene(), Scene().fix(std::vector<NodeId>{0}), Scene().fix(std::vector<NodeId>{0, 3}),
                             Scene().prescribe("x0", {0.0, std::nullopt, std::nullopt})})
    for (PolicyName policy : extreme_policies) {
      Scene touched = scene;
      CHECK_REFUSED(SetupErrorKind::unconstrained, make_model(policy, brick(), touched.touch("z1"), plain));
    }
}

TEST_CASE("two tetrahedra joined at a node or an edge", "[extreme][B7][B8]") {
  for (bool turn : {false, true}) {
    const auto mesh = [turn](int shared) { return turn ? rotated(joined(shared)) : joined(shared); };
    const auto constrained = std::vector<NodeId>{0, 1, 2, 3}, three = std::vector<NodeId>{1, 2, 3};
    for (int shared : {1, 2}) {
      INFO(shared << " nodes shared");
      for (const auto& nodes : {constrained, three}) {
        const Scene scene = Scene().fix(nodes);
        check_refused_by_all(mesh(shared), scene);                          // everything condensed
        check_refused_by_all(mesh(shared), Scene(scene).touch("surface"));  // everything kept
        check_refused_by_all(mesh(shared), Scene(scene).touch("surface").gravity({1, 2, 3}));
        check_refused_by_all(mesh(shared), Scene(scene).touch("surface").point_load("surface", {1, 2, 3}));
      }
    }
    judge_all("a shared face is a rigid joint", mesh(3), {plain},
              Scene().fix(constrained).touch("surface").gravity({1, 2, 3}),
              [](PolicyName, const Outcome& o) { CHECK(o.verdict != Verdict::refused); });
  }
}

TEST_CASE("two bricks joined by a hinge or a corner", "[extreme][B7][B8]") {
  for (bool edge : {true, false})
    for (bool turn : {false, true}) {
      INFO((edge ? "hinge" : "corner") << (turn ? ", rotated" : ""));
      const Mesh<Tet4> mesh = turn ? rotated(hinged_bricks(edge)) : hinged_bricks(edge);
      REQUIRE(detail::connected_components<Tet4>(mesh).count == 1);
      REQUIRE(mesh.node_count() == (edge ? 69 : 71));
      const Scene scene = Scene().fix(brick().find_group("x0")->nodes);
      check_refused_by_all(mesh, scene);
      check_refused_by_all(mesh, Scene(scene).touch("surface"));
      check_refused_by_all(mesh, Scene(scene).touch(brick().find_group("z0")->nodes).gravity({1, 2, 3}));
    }
}

TEST_CASE("a surface with an edge shared by four faces is reported, and can be touched", "[extreme][B11]") {
  const Mesh<Tet4> mesh = hinged_bricks(true);
  std::vector<NodeId> constrained;
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i).x() < 1e-9 || mesh.position(i).x() > 0.2 - 1e-9) constrained.push_back(i);
  const auto model = make_model(PolicyName::sparse_cholesky, mesh, Scene().fix(constrained).touch("surface"), plain);
  CHECK(model->report().has(SetupFlag::non_manifold));
  const auto plain_model = make_model(PolicyName::sparse_cholesky, brick(), brick_scene(), plain);
  CHECK(!plain_model->report().has(SetupFlag::non_manifold));
  CHECK(testing::describe(testing::tissue_laws(*model, all_vertices(model->contact_surface().vertex_count()),
                                               {accuracy(PolicyName::sparse_cholesky)})) == "");
}

TEST_CASE("one element", "[extreme][B9]") {
  const Mesh<Tet4> mesh = [] {
    Mesh<Tet4> m;
    m.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
    m.elements = {{0, 1, 2, 3}};
    return m;
  }();
  const Scene scene = Scene().fix(std::vector<NodeId>{0, 1, 2}).touch("surface").gravity({1, 2, -9.81});
  judge_all("one element", mesh, {plain}, scene, [](PolicyName policy, const Outcome& o) {
    CHECK(o.error <= (policy == PolicyName::condensed_float ? 1e-6 : 1e-11));
  });
}

TEST_CASE("all nodes fixed", "[extreme][B9]") {
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const auto still =
        make_model(policy, brick(),
                   Scene().fix("surface").fix(std::vector<NodeId>{17, 18}).touch("z1").gravity({0, 0, -9.81}), plain);
    CHECK(still->report().free_dofs == 0);
    CHECK(still->displacement().isZero(0.0));
    CHECK(still->require_columns(all_vertices(12)).ok());
    CHECK(still->compliance(3, 3).isZero(0.0));
    CHECK(still->compliance_bound(3) == 0.0);
    CHECK(still->compliance_floor() > 0.0);
    Vector3 weight = Vector3::Zero();
    for (Index i = 0; i < 36; ++i) weight += still->reactions().segment<3>(3 * i);
    CHECK(largest(weight - Vector3(0, 0, 9.81 * 1000 * 0.1 * 0.06 * 0.04)) <= 1e-12);
    VectorX u(108);
    CHECK(still->displacement_with(std::array{VertexForce{3, {1, 2, 3}}}, u).converged);
    CHECK(u.isZero(0.0));
  }
}

TEST_CASE("a touchable surface that is fixed, on a body that is not", "[extreme][B9]") {
  const Scene scene = Scene().fix("z1").touch("z1").gravity({0, 0, -9.81});
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), scene, plain);
    CHECK(model->report().kept_dofs == 0);
    CHECK(relative(model->displacement(), Reference(brick(), {plain}, scene).displacement) <= accuracy(policy));
    CHECK(model->require_columns(all_vertices(12)).ok());
    CHECK(model->compliance(2, 5).isZero(0.0));
  }
}

TEST_CASE("no force: exactly no displacement", "[extreme][B9]") {
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), brick_scene(), plain);
    CHECK(model->displacement().isZero(0.0));
    CHECK(model->internal_force().isZero(0.0));
    CHECK(model->reactions().isZero(0.0));
    CHECK(model->strain_energy() == 0.0);
    VectorX u = VectorX::Ones(108);
    model->displacement_with({}, u);
    CHECK(u.isZero(0.0));
  }
}

TEST_CASE("a rigid motion of the support moves the body without strain", "[extreme][B9]") {
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), Scene().prescribe("x0", {0.01, -0.02, 0.03}).touch("z1"), plain);
    for (Index i = 0; i < 36; ++i)
      CHECK(largest(model->displacement().segment<3>(3 * i) - Vector3(0.01, -0.02, 0.03)) <= 1e-2 * accuracy(policy));
  }
}

TEST_CASE("the dense matrix of a large surface is refused before it is allocated", "[extreme][B10]") {
  // 13 000 touched vertices: 12 GB of compliance. The limit of one gigabyte must be checked first, and reported with
  // the number.
  const Mesh<Tet4> mesh = box_tet4({0.1, 0.1, 0.001}, {113, 113, 1});
  SetupOptions options;
  options.memory_limit = std::size_t{1} << 30;
  const SetupProblem p =
      refusal([&] { make_model(PolicyName::condensed_inverse, mesh, Scene().fix("x0").touch("z1"), plain, options); });
  CHECK(to_string(p.kind) == "too_large");
  const double dofs = 3.0 * 114 * 113;
  CHECK(p.value >= 8.0 * dofs * dofs);
  CHECK(p.value <= 40.0 * dofs * dofs);
}

TEST_CASE("byte counts beyond 32 bits", "[extreme][B10]") {
  SetupLimits limits;
  limits.memory = std::numeric_limits<std::size_t>::max();
  CHECK_NOTHROW(limits.require_memory(9.0 * 2e5 * 2e5 * 8.0, "a matrix"));
  limits.memory = std::size_t{1} << 40;
  CHECK_REFUSED(SetupErrorKind::too_large, limits.require_memory(9.0 * 2e5 * 2e5 * 8.0, "a matrix"));
}
