// What meshes make of the compliance of a half-space.
#include <palpate/element/wrappers.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include "model/half_space_bodies.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <cmath>

using namespace test;
using Catch::Matchers::WithinAbs;

namespace {

constexpr int width = 8, depth = 5;

/// A block fixed below and touched above.
template <Element E>
TouchedBlock<E> block_of(Mesh<E> mesh, double poisson_ratio) {
  return {std::move(mesh), LinearElastic{1.0, poisson_ratio, 1.0}, [](const Vector3& x) { return x[2] < 1e-9; },
          [](const Vector3& x) { return x[2] > depth - 1e-9; }};
}

template <Element E>
TouchedBlock<E> uneven_block(double poisson_ratio) {
  return block_of(jittered_block<E>(width, depth, 0.2), poisson_ratio);
}

/// Largest difference of corresponding blocks, relative to the largest block.
template <class Expected>
double difference(const detail::ProjectedHalfSpace& table, Expected&& expected) {
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i < table.vertex_count(); ++i)
    for (int j = 0; j <= i; ++j) {
      worst = std::max(worst, (table(i, j) - expected(i, j)).cwiseAbs().maxCoeff());
      largest = std::max(largest, table(i, j).cwiseAbs().maxCoeff());
    }
  return worst / largest;
}

/// Mean, and standard deviation over the mean, of the normal compliance of vertices far from the sides: of the mesh,
/// and of what is left without the image of the half-space.
struct Scatter {
  double mean = 0.0, of_mesh = 0.0, rest = 0.0, of_rest = 0.0;
};

template <Element E>
Scatter scatter_of(const Mesh<E>& mesh, double poisson_ratio) {
  Scene scene;
  scene.fix("z0").touch("z1");
  const HapticFEModel<E, LinearElastic> model(mesh, scene, LinearElastic{1.0, poisson_ratio, 1.0});
  const auto table =
      detail::project_half_space<E>(model.body(), model.boundary(), model.touchable_nodes(),
                                    resolve_essential(model.mesh(), model.boundary(), scene).constrained, nullptr, {});
  std::vector<double> whole, rest;
  for (int v = 0; v < table.vertex_count(); ++v)
    if (table.vertex(v).position.template head<2>().cwiseAbs().maxCoeff() < 2.5) {
      whole.push_back(model.compliance(v, v)(2, 2));
      rest.push_back(whole.back() - table(v, v)(2, 2));
    }
  const auto mean = [](const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  };
  const auto deviation = [&](const std::vector<double>& x) {
    double sum = 0.0;
    for (const double value : x) sum += std::pow(value - mean(x), 2);
    return std::sqrt(sum / static_cast<double>(x.size()));
  };
  return {mean(whole), deviation(whole) / mean(whole), mean(rest), deviation(rest) / mean(whole)};
}

}  // namespace

TEMPLATE_TEST_CASE("the image of a half-space scales, moves and rotates with the mesh", "[half_space]", Tet4,
                   Smoothed<Tet4>) {
  const double nu = GENERATE(0.3, 0.4999);
  const TouchedBlock<TestType> block = uneven_block<TestType>(nu);
  const detail::ProjectedHalfSpace table = block.table();
  REQUIRE(table.vertex_count() == (width + 1) * (width + 1));
  CHECK(difference(table, [&](int i, int j) { return Matrix3(table(j, i).transpose()); }) == 0.0);

  testing::Random random(23);
  const Matrix3 axes = testing::random_rotation(random);
  const double length = 0.02, stiffness = 300.0;
  TouchedBlock<TestType> other = block;
  for (Vector3& x : other.body.mesh.positions) x = length * (axes * x) + Vector3(0.3, -0.2, 0.1);
  other.body.elasticity[0] = stiffness * block.body.elasticity[0];
  other.stiffness = assemble_stiffness<TestType>(other.body, {});
  const double scale = 1.0 / (length * stiffness);
  CHECK(difference(other.table(), [&](int i, int j) { return scale * (axes * table(i, j) * axes.transpose()); }) <=
        1e-9);

  // With nodes in reverse order, vertices are, too.
  TouchedBlock<TestType> reversed = block;
  const NodeId last = static_cast<NodeId>(block.body.mesh.node_count()) - 1;
  std::ranges::reverse(reversed.body.mesh.positions);
  for (auto& element : reversed.body.mesh.elements)
    for (NodeId& n : element) n = last - n;
  std::ranges::reverse(reversed.constrained);
  std::ranges::reverse(reversed.touched);
  for (NodeId& n : reversed.touched) n = last - n;
  reversed.boundary = extract_boundary<TestType>(reversed.body.mesh);
  reversed.stiffness = assemble_stiffness<TestType>(reversed.body, {});
  const int count = table.vertex_count();
  CHECK(difference(reversed.table(), [&](int i, int j) { return table(count - 1 - i, count - 1 - j); }) <= 1e-9);
}

TEMPLATE_TEST_CASE("the load on a surface that is nearly flat is nearly a unit force", "[half_space]", Tet4, Hex8,
                   Tet10, Hex20) {
  // A surface that is flat to the last bit needs no quadrature, any other needs all of it.
  const Vector3 size(width, width, depth);
  constexpr bool linear = TestType::order == 1;
  const std::array<int, 3> cells{linear ? width : width / 2, linear ? width : width / 2, linear ? depth : 3};
  Mesh<TestType> mesh = [&] {
    if constexpr (TestType::nodes == 4) return box_tet4(size, cells);
    if constexpr (TestType::nodes == 8) return box_hex8(size, cells);
    if constexpr (TestType::nodes == 10) return box_tet10(size, cells);
    if constexpr (TestType::nodes == 20) return box_hex20(size, cells);
  }();
  const detail::ProjectedHalfSpace flat = block_of(mesh, 0.45).table();
  testing::Random random(41);
  TouchedBlock<TestType> bumpy = block_of(mesh, 0.45);
  for (const NodeId n : bumpy.touched)
    bumpy.body.mesh.positions[static_cast<std::size_t>(n)][2] -= 1e-7 * random.uniform();
  const detail::ProjectedHalfSpace table = bumpy.table();
  for (int v = 0; v < flat.vertex_count(); ++v)
    if (flat.marks(v).bits == 0) CHECK((table(v, v) - flat(v, v)).norm() <= 1e-3 * flat(v, v).norm());
}

TEST_CASE("the image of a half-space has the same bits for any number of threads", "[half_space]") {
  const TouchedBlock<Tet4> block = uneven_block<Tet4>(0.45);
  SetupLimits three;
  three.threads = SetupThreads(3);
  const detail::ProjectedHalfSpace one = block.table();
  CHECK(difference(block.table(three), [&](int i, int j) { return one(i, j); }) == 0.0);
}

TEST_CASE("without the image of a half-space equal vertices have equal compliance", "[half_space]") {
  const Scatter plain = scatter_of<Tet4>(jittered_block<Tet4>(12, 8, 0.2), 0.3);
  CHECK(plain.of_mesh >= 0.05);
  CHECK(plain.of_rest <= 0.015);
  CHECK(std::abs(plain.rest) <= 0.1 * plain.mean);
  const Scatter smoothed = scatter_of<Smoothed<Tet4>>(jittered_block<Smoothed<Tet4>>(12, 8, 0.2), 0.45);
  CHECK(smoothed.of_mesh >= 0.1);
  CHECK(smoothed.of_rest <= 0.01);
}

TEST_CASE("what is left without the image of a half-space does not depend on the element", "[half_space]") {
  const double nu = 0.45;
  const Vector3 size(12.0, 12.0, 8.0);
  const std::array<int, 3> cells{12, 12, 8}, half{6, 6, 4};
  const double largest = 1.6;  // compliance of a vertex of Smoothed<Tet4>
  const double reference = scatter_of<Hex8>(box_hex8(size, cells), nu).rest;
  CHECK_THAT(scatter_of<Tet4>(box_tet4(size, cells), nu).rest, WithinAbs(reference, 0.02 * largest));
  CHECK_THAT(scatter_of<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(box_tet4(size, cells)), nu).rest,
             WithinAbs(reference, 0.03 * largest));
  CHECK_THAT(scatter_of<Tet10>(box_tet10(size, half), nu).rest, WithinAbs(reference, 0.03 * largest));
  CHECK_THAT(scatter_of<Hex20>(box_hex20(size, half), nu).rest, WithinAbs(reference, 0.03 * largest));
}

TEST_CASE("vertices at which a surface is no half-space are marked", "[half_space]") {
  const TouchedBlock<Tet4> block = uneven_block<Tet4>(0.3);
  const detail::ProjectedHalfSpace table = block.table();
  for (int v = 0; v < table.vertex_count(); ++v) {
    const Vector3& x = table.vertex(v).position;
    const double to_edge = std::min({x[0], x[1], width - x[0], width - x[1]});
    CHECK(table.marks(v).has(detail::HalfSpaceMark::sharp_edge) == (to_edge < 1e-9));
    if (to_edge > 2.0) CHECK(table.marks(v).bits == 0);
    if (to_edge > 0.5 && to_edge < 1.3) CHECK(table.marks(v).has(detail::HalfSpaceMark::near_edge));
  }
}

TEST_CASE("vertices inside the body, or without a solution, keep the compliance of the mesh", "[half_space]") {
  TouchedBlock<Tet4> block = uneven_block<Tet4>(0.3);
  const NodeId inside = [&] {
    for (NodeId n = 0;; ++n)
      if ((block.body.mesh.position(n) - Vector3(4.0, 4.0, 3.0)).norm() < 0.5) return n;
  }();
  block.touched.push_back(inside);
  std::ranges::sort(block.touched);
  const int vertex = static_cast<int>(std::ranges::find(block.touched, inside) - block.touched.begin());
  const detail::ProjectedHalfSpace table = block.table();
  CHECK(table.marks(vertex).has(detail::HalfSpaceMark::no_surface));
  CHECK(table.vertex(vertex).root == 0.0);
  CHECK(table.columns(vertex).empty());
  // A stiffness without springs at one node has a pivot that is zero.
  block.stiffness.block(block.stiffness.pattern().diagonal(inside)).setZero();
  const detail::ProjectedHalfSpace broken = block.table();
  int singular = 0;
  for (int v = 0; v < broken.vertex_count(); ++v)
    if (broken.marks(v).has(detail::HalfSpaceMark::singular)) {
      ++singular;
      CHECK(broken.columns(v).empty());
    }
  CHECK(singular > 0);
}

TEST_CASE("several materials and materials with directions are marked", "[half_space]") {
  TouchedBlock<Tet4> block = uneven_block<Tet4>(0.3);
  const detail::ProjectedHalfSpace one = block.table();
  block.body.elasticity.push_back(4.0 * block.body.elasticity[0]);
  block.body.mesh.region_names.push_back("right");
  for (Index e = 0; e < block.body.mesh.element_count(); ++e)
    block.body.mesh.regions.push_back(element_nodes<Tet4>(block.body.mesh, e).col(0).mean() > width / 2 ? 1 : 0);
  block.body.density.push_back(1.0);
  block.body.initial_strain.push_back(Vector6::Zero());
  const detail::ProjectedHalfSpace two = block.table();
  for (int v = 0; v < two.vertex_count(); ++v) {
    const double x = two.vertex(v).position[0];
    const double to_border = std::abs(x - width / 2);
    if (to_border < 1.5) CHECK(two.marks(v).has(detail::HalfSpaceMark::several_materials));
    if (to_border > 2.5) CHECK_FALSE(two.marks(v).has(detail::HalfSpaceMark::several_materials));
    const double softer = x > width / 2 + 0.5 ? 0.25 : 1.0;
    if (to_border > 0.5) CHECK((two(v, v) - softer * one(v, v)).norm() <= 1e-9 * one(v, v).norm());
  }
  block.body.elasticity[0](0, 0) *= 2.0;
  CHECK(block.table().marks(0).has(detail::HalfSpaceMark::anisotropic));
}

TEST_CASE("a layer that is thinner than its facets is marked, whatever its number of elements", "[half_space]") {
  // Three layers of elements to x_3 = 4.7, below facets of length 1.
  Mesh<Tet4> mesh = jittered_block<Tet4>(width, depth, 0.0);
  for (Vector3& x : mesh.positions)
    if (x[2] > 1.5) x[2] = 4.7 + 0.1 * (x[2] - 2.0);
  const double border = 4.7;
  TouchedBlock<Tet4> block = block_of(std::move(mesh), 0.3);
  const auto marked = [&] {
    const detail::ProjectedHalfSpace table = block.table();
    int count = 0;
    for (int v = 0; v < table.vertex_count(); ++v)
      count += table.marks(v).has(detail::HalfSpaceMark::several_materials);
    return count;
  };
  CHECK(marked() == 0);
  block.body.elasticity.push_back(100.0 * block.body.elasticity[0]);
  block.body.mesh.region_names.push_back("skin");
  for (Index e = 0; e < block.body.mesh.element_count(); ++e)
    block.body.mesh.regions.push_back(element_nodes<Tet4>(block.body.mesh, e).col(2).mean() > border ? 1 : 0);
  block.body.density.push_back(1.0);
  block.body.initial_strain.push_back(Vector6::Zero());
  CHECK(marked() == block.table().vertex_count());
}

TEST_CASE("vertices that are constrained along the surface are marked", "[half_space]") {
  TouchedBlock<Tet4> block = uneven_block<Tet4>(0.3);
  const auto middle = static_cast<std::size_t>(block.touched[block.touched.size() / 2]);
  CHECK_FALSE(block.table().marks(static_cast<int>(block.touched.size() / 2)).has(detail::HalfSpaceMark::near_support));
  block.constrained[middle] = 1;
  CHECK(block.table().marks(static_cast<int>(block.touched.size() / 2)).has(detail::HalfSpaceMark::near_support));
}

TEST_CASE("the projection of a half-space refuses lists of other sizes", "[half_space]") {
  TouchedBlock<Tet4> block = uneven_block<Tet4>(0.3);
  block.constrained.pop_back();
  CHECK_REFUSED(SetupErrorKind::bad_argument, block.table());
}
