// The stiffness of whole bodies, stored and matrix-free.
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/testing/assembler_laws.hpp>

#include "assembly/bodies.hpp"
#include "assembly/csv.hpp"
#include "element/user_elements.hpp"
#include "local/closed_form.hpp"
#include "mesh/two_cubes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace test;

namespace {

template <Element E>
void check_laws(const Body<E>& body, Index pieces = 1) {
  const BlockMatrix stored = assemble_stiffness<E>(body, {});
  const detail::MatrixFreeStiffness<E> free(body, {});
  CHECK(testing::describe(testing::stiffness_laws(body, stored, pieces)) == "");
  CHECK(testing::describe(testing::stiffness_laws(body, free, pieces)) == "");
  CHECK(testing::describe(testing::same_stiffness_laws(stored, free)) == "");
}

Mesh<Tet4> twice(const Mesh<Tet4>& one) {
  Mesh<Tet4> both = one;
  for (const Vector3& x : one.positions) both.positions.push_back(x + Vector3(5, 0, 0));
  for (auto element : one.elements) {
    for (NodeId& i : element) i += static_cast<NodeId>(one.node_count());
    both.elements.push_back(element);
  }
  both.regions.clear();
  both.region_names = {"body"};
  return both;
}

}  // namespace

TEST_CASE("assembled and matrix-free stiffness pass the law suite", "[assembly][laws]") {
  SECTION("two cubes") {
    check_laws(body_of(two_cubes(), {reference_material}));
  }
  SECTION("two cubes of two materials") {
    check_laws(body_of(two_cubes(), {liver, reference_material}));
  }
  SECTION("sphere") {
    check_laws(body_of(sphere_tet4(0.05, 2), {liver}));
  }
  SECTION("distorted box") {
    check_laws(body_of(jittered(box_tet4({1, 2, 3}, {3, 2, 2}), 0.1, {1, 2, 3}), {liver}));
  }
  SECTION("a size of one micrometre") {
    check_laws(body_of(sphere_tet4(1e-6, 1), {liver}));
  }
  SECTION("two separate bodies have twelve rigid motions") {
    check_laws(body_of(twice(two_cubes()), {liver}), 2);
  }
  SECTION("an orthotropic body") {
    Body<Tet4> body = body_of(sphere_tet4(1.0, 1), {liver});
    body.elasticity.front() = orthotropic();
    check_laws(body);
  }
  SECTION("elements of every kind, isotropic and orthotropic") {
    const auto check_both = [](auto body) {
      check_laws(body);
      body.elasticity.front() = orthotropic();
      check_laws(body);
    };
    check_both(body_of(box_tet10({1, 2, 3}, {1, 1, 2}), {liver}));
    check_both(body_of(box_hex8({1, 2, 3}, {2, 2, 1}), {liver}));
    check_both(body_of(box_hex20({1, 2, 3}, {2, 1, 1}), {liver}));
  }
  SECTION("one hexahedron of a user's element type") {
    Mesh<user::Hex8> mesh;
    for (int a = 0; a < 8; ++a) {
      mesh.positions.push_back(user::Hex8::reference_nodes().row(a).transpose());
      mesh.elements.resize(1);
      mesh.elements[0][static_cast<std::size_t>(a)] = a;
    }
    check_laws(body_of(mesh, {liver}));
  }
}

TEST_CASE("K of the two cubes equals that of another code", "[assembly][oracle]") {
  const MatrixX reference = read_matrix(two_cubes_folder + "K_getfem.csv");
  REQUIRE(reference.rows() == 36);
  REQUIRE(reference.cols() == 36);
  const Body<Tet4> body = body_of(two_cubes(), {reference_material});
  CHECK(largest(testing::dense_matrix(assemble_stiffness<Tet4>(body, {})) - reference) <= 1e-12 * largest(reference));
  CHECK(largest(testing::dense_matrix(detail::MatrixFreeStiffness<Tet4>(body, {})) - reference) <=
        1e-12 * largest(reference));
}

TEST_CASE("K of a body equals the closed form", "[assembly][closed_form]") {
  const Body<Tet4> body = body_of(two_cubes(), {liver, {2e5, -0.3, 0.0}});
  const auto exact = closed_form_stiffness<long double>(body.mesh, {liver, {2e5, -0.3, 0.0}});
  const MatrixX k = testing::dense_matrix(assemble_stiffness<Tet4>(body, {}));
  CHECK(largest(k.cast<long double>() - exact) <= 1e-14 * largest(exact));
}

TEST_CASE("the pattern contains each pair of neighbours once", "[assembly][pattern]") {
  const Mesh<Tet4> mesh = two_cubes();
  const detail::BlockPattern pattern = detail::block_pattern(mesh);
  REQUIRE(pattern.rows() == 12);
  for (NodeId i = 0; i < 12; ++i) {
    const auto begin = pattern.column.begin() + pattern.row_start[static_cast<std::size_t>(i)];
    const auto end = pattern.column.begin() + pattern.row_start[static_cast<std::size_t>(i) + 1];
    CHECK(std::is_sorted(begin, end));
    CHECK(std::adjacent_find(begin, end) == end);
    CHECK(*(end - 1) == i);
    for (NodeId j = 0; j <= i; ++j) {
      const bool neighbours = i == j || std::ranges::any_of(mesh.elements, [&](const auto& e) {
                                return std::ranges::find(e, i) != e.end() && std::ranges::find(e, j) != e.end();
                              });
      CHECK(std::binary_search(begin, end, j) == neighbours);
      if (neighbours) CHECK(pattern.column[static_cast<std::size_t>(pattern.find(i, j))] == j);
    }
  }
}

TEST_CASE("free_matrix is the lower half of K without the prescribed dofs", "[assembly]") {
  const Body<Tet4> body = body_of(two_cubes(), {reference_material});
  const BlockMatrix k = assemble_stiffness<Tet4>(body, {});
  Scene scene;
  scene.fix("fixed").prescribe("load_point", {std::nullopt, 0.1, std::nullopt});
  const EssentialConditions c = conditions_of(body.mesh, scene);
  REQUIRE(c.free_count() == 36 - 12 - 1);
  const MatrixX all = testing::dense_matrix(k), lower = MatrixX(free_matrix(k, c));
  MatrixX expected = MatrixX::Zero(c.free_count(), c.free_count());
  for (Index i = 0; i < c.free_count(); ++i)
    for (Index j = 0; j <= i; ++j)
      expected(i, j) = all(c.free_dofs[static_cast<std::size_t>(i)], c.free_dofs[static_cast<std::size_t>(j)]);
  CHECK(lower == expected);
  const detail::FreeStiffness op(k, c);
  const MatrixX by_apply = testing::dense_matrix(op);
  CHECK(largest(by_apply - MatrixX(expected.selfadjointView<Eigen::Lower>())) <= 1e-13 * largest(expected));
  VectorX x = VectorX::Ones(op.size()), y(op.size());
  op.precondition(x, y);
  CHECK(y.allFinite());
  CHECK(x.dot(y) > 0.0);
}

TEST_CASE("an element whose stiffness overflows is refused with its id", "[assembly][extreme][B3]") {
  Body<Tet4> body = body_of(two_cubes(), {reference_material});
  body.mesh.positions[11] = body.mesh.positions[10];  // element 8 has no volume
  const auto check = [](const SetupProblem& p) {
    CHECK(to_string(p.kind) == "non_finite");
    CHECK(p.ids == std::vector<std::int64_t>{8});
  };
  check(refusal([&] { assemble_stiffness<Tet4>(body, {}); }));
  check(refusal([&] { detail::MatrixFreeStiffness<Tet4>(body, {}); }));
}

TEST_CASE("assembly by rows gives the same bits on any number of threads", "[assembly][threads]") {
  Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {26, 26, 26});
  mesh.region_names = {"soft", "stiff"};
  for (Index e = 0; e < mesh.element_count(); ++e) mesh.regions.push_back(static_cast<int>(e % 2));
  std::mt19937 random(7);
  std::vector<NodeId> number(mesh.positions.size());  // irregular, as a mesh generator leaves it
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  const std::vector<Vector3> positions = mesh.positions;
  for (std::size_t i = 0; i < number.size(); ++i) mesh.positions[static_cast<std::size_t>(number[i])] = positions[i];
  for (auto& element : mesh.elements)
    for (NodeId& i : element) i = number[static_cast<std::size_t>(i)];
  Body<Tet4> body = body_of(mesh, {liver, {2e5, 0.1, 0.0}});
  REQUIRE(body.mesh.node_count() > 2 * 8192);  // more than one group of rows

  const BlockMatrix one = assemble_stiffness<Tet4>(body, {});
  const detail::MatrixFreeStiffness<Tet4> by_elements(body, {});
  VectorX x(one.size()), y(one.size()), expected(one.size());
  for (Index i = 0; i < x.size(); ++i) x[i] = std::sin(static_cast<double>(i));
  one.apply(x, y);
  by_elements.apply(x, expected);
  CHECK((y - expected).norm() <= 1e-13 * expected.norm());
  for (const int threads : {2, 3, 7}) {
    SetupLimits limits;
    limits.threads = threads;
    const BlockMatrix several = assemble_stiffness<Tet4>(body, limits);
    bool same = true;
    for (Index p = 0; p < static_cast<Index>(one.pattern().column.size()); ++p)
      same = same && several.block(p) == one.block(p);
    CHECK(same);
  }

  for (const NodeId e : {70000, 20000, 60000})  // the first is named, whatever thread finds it
    std::swap(body.mesh.elements[static_cast<std::size_t>(e)][0], body.mesh.elements[static_cast<std::size_t>(e)][1]);
  for (const int threads : {1, 3}) {
    SetupLimits limits;
    limits.threads = threads;
    const SetupProblem p = refusal([&] { assemble_stiffness<Tet4>(body, limits); });
    CHECK(p.kind == SetupErrorKind::inverted_element);
    CHECK(p.ids == std::vector<std::int64_t>{20000});
  }
}

TEST_CASE("assembly can be cancelled", "[assembly]") {
  const Body<Tet4> body = body_of(two_cubes(), {reference_material});
  SetupLimits limits;
  limits.progress = [](const Progress& p) { return p.stage != "assembly"; };
  CHECK_REFUSED(SetupErrorKind::cancelled, assemble_stiffness<Tet4>(body, limits));
  CHECK_REFUSED(SetupErrorKind::cancelled, detail::MatrixFreeStiffness<Tet4>(body, limits));
}

TEST_CASE("an element that is inverted at an integration point is refused", "[assembly][extreme]") {
  Mesh<Hex8> mesh = box_hex8({1, 1, 1}, {2, 2, 2});
  mesh.positions[13] = Vector3(0.05, 0.05, 0.05);  // the middle node, moved into a corner
  const auto problem = refusal([&] { assemble_stiffness<Hex8>(body_of(mesh, {liver}), {}); });
  CHECK(problem.kind == SetupErrorKind::inverted_element);
  CHECK(problem.ids == std::vector<std::int64_t>{0});
}
