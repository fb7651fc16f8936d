// Natural frequencies against closed forms and, in the next file, other codes.
#include <palpate/model/static/natural_frequencies.hpp>

#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/generators_box.hpp>

#include <Eigen/Eigenvalues>

#include "assembly/bodies.hpp"
#include "mesh/two_cubes.hpp"

#include <numeric>

using namespace test;
using Catch::Matchers::WithinRel;

namespace {

constexpr double pi = std::numbers::pi;

/// omega L sqrt(rho / mu) of every mode.
VectorX reduced(const NaturalFrequencies& modes, const LinearElastic& m, double length) {
  return 2.0 * pi * length * std::sqrt(m.density / m.shear_modulus()) * modes.frequencies;
}

/// All eigenvalues of K x = lambda M x by a dense solver [1/s^2].
template <Element E>
VectorX dense_eigenvalues(const Body<E>& body, const Scene& scene) {
  const EssentialConditions conditions = conditions_of(body.mesh, scene);
  const MatrixX k = MatrixX(free_matrix(assemble_stiffness<E>(body, {}), conditions));
  const MatrixX m = MatrixX(free_matrix(assemble_mass<E>(body), conditions));
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixX>(k, m, Eigen::EigenvaluesOnly).eigenvalues();
}

template <Element E>
void check_shapes(const Body<E>& body, const NaturalFrequencies& modes) {
  const detail::MassMatrix m = assemble_mass(body);
  MatrixX all(m.size(), modes.rigid_shapes.cols() + modes.shapes.cols()), moved = all;
  all << modes.rigid_shapes, modes.shapes;
  VectorX y(m.size());
  for (Index k = 0; k < all.cols(); ++k) {
    m.apply(all.col(k), y);
    moved.col(k) = y;
  }
  CHECK((all.transpose() * moved - MatrixX::Identity(all.cols(), all.cols())).cwiseAbs().maxCoeff() <= 1e-10);
  CHECK(modes.residuals.maxCoeff() <= 1e-6);
}

}  // namespace

TEST_CASE("the free cube has the exact modes", "[model][modal]") {
  // NUMERICS.md 7 item 10: Ritz degree 12; the Lame mode pi sqrt 2 is exact and the same for any Poisson ratio.
  const LinearElastic m{3e3, 0.3, 1100.0};
  const double length = 0.05;
  const auto body = make_body(box_hex20(Vector3::Constant(length), {5, 5, 5}), m);
  const NaturalFrequencies modes = natural_frequencies(body, {}, 12);
  REQUIRE(modes.rigid_modes() == 6);
  const VectorX w = reduced(modes, m, length);
  const std::array exact{2.8561,
                         2.8561,
                         3.8460,
                         3.8460,
                         3.8460,
                         3.9113,
                         3.9113,
                         3.9113,
                         pi * std::sqrt(2.0),
                         pi * std::sqrt(2.0),
                         pi * std::sqrt(2.0),
                         4.5728};
  for (std::size_t k = 0; k < exact.size(); ++k) CHECK_THAT(w[static_cast<Index>(k)], WithinRel(exact[k], 2e-3));
  for (Index k : {8, 9, 10}) CHECK(w[k] > pi * std::sqrt(2.0));  // a Ritz method bounds from above
  CHECK_THAT(w[1], WithinRel(w[0], 1e-9));                       // by symmetry of the mesh
  CHECK_THAT(w[3], WithinRel(w[2], 1e-9));
  CHECK_THAT(w[4], WithinRel(w[2], 1e-9));
  CHECK_THAT(w[7], WithinRel(w[5], 1e-9));
  check_shapes(body, modes);
}

TEST_CASE("the Lame mode converges with fourth order", "[model][modal]") {
  const LinearElastic m{3e3, 0.45, 1100.0};
  const auto error = [&](int cells) {
    const auto body = make_body(box_hex20(Vector3::Constant(1.0), {cells, cells, cells}), m);
    const VectorX w = reduced(natural_frequencies(body, {}, 11), m, 1.0);
    return (w.array() / (pi * std::sqrt(2.0)) - 1.0).abs().minCoeff();
  };
  const double coarse = error(3), fine = error(6);
  CHECK(fine <= 3e-4);
  CHECK(std::log2(coarse / fine) >= 3.6);
}

TEMPLATE_TEST_CASE("the frequencies of small bodies are those of a dense solver", "[model][modal]", Tet4, Tet10, Hex8) {
  using E = TestType;
  const auto body = [] {
    if constexpr (E::nodes == 4) return make_body(jittered(box_tet4({1, 2, 3}, {2, 2, 3}), 0.1, {1, 2, 3}), liver);
    if constexpr (E::nodes == 8) return make_body(box_hex8({1, 2, 3}, {2, 2, 3}), liver);
    if constexpr (E::nodes == 10) return make_body(box_tet10({1, 2, 3}, {1, 1, 2}), liver);
  }();
  Scene constrained, sliding;
  constrained.fix("z0");
  sliding.prescribe("z0", {std::nullopt, std::nullopt, 0.0});
  for (const auto& [scene, rigid] : {std::pair(Scene{}, 6), std::pair(sliding, 3), std::pair(constrained, 0)}) {
    const VectorX all = dense_eigenvalues(body, scene);
    for (int count : {1, 7, static_cast<int>(all.size()) - rigid}) {
      INFO(rigid << " rigid, " << count << " modes");
      const NaturalFrequencies modes = natural_frequencies(body, scene, count);
      REQUIRE(modes.rigid_modes() == rigid);
      for (Index k = 0; k < count; ++k)
        CHECK_THAT(modes.frequencies[k], WithinRel(std::sqrt(all[rigid + k]) / (2.0 * pi), 1e-8));
      check_shapes(body, modes);
    }
  }
}

TEST_CASE("a bar on rollers has the frequencies of the wave equation", "[model][modal]") {
  // u_y = u_z = 0: f_k = (2 k - 1) c / (4 L) with c^2 = (lambda + 2 mu) / rho; no shear, no bending.
  const LinearElastic m{1e4, 0.4, 1000.0};
  const auto body = make_body(box_hex20({1.0, 0.05, 0.05}, {20, 1, 1}), m);
  Scene scene;
  std::vector<NodeId> all(body.mesh.positions.size());
  std::iota(all.begin(), all.end(), 0);
  scene.prescribe(all, {std::nullopt, 0.0, 0.0}).prescribe("x0", {0.0, 0.0, 0.0});
  const NaturalFrequencies modes = natural_frequencies(body, scene, 3);
  const double c = std::sqrt((m.lame_lambda() + 2.0 * m.shear_modulus()) / m.density);
  for (Index k = 0; k < 3; ++k)
    CHECK_THAT(modes.frequencies[k], WithinRel(static_cast<double>(2 * k + 1) * c / 4.0, 2e-5));
}

TEST_CASE("two separate bodies have twelve rigid motions and every frequency twice", "[model][modal]") {
  const Mesh<Tet4> one = box_tet4({0.1, 0.2, 0.3}, {1, 2, 3});
  Mesh<Tet4> two = one;
  for (const Vector3& x : one.positions) two.positions.push_back(x + Vector3(5, 0, 0));
  for (auto element : one.elements) {
    for (NodeId& i : element) i += static_cast<NodeId>(one.node_count());
    two.elements.push_back(element);
  }
  two.groups = {};
  const auto single = natural_frequencies(make_body(one, liver), {}, 5);
  const auto pair = natural_frequencies(make_body(two, liver), {}, 10);
  CHECK(pair.rigid_modes() == 12);
  for (Index k = 0; k < 10; ++k) CHECK_THAT(pair.frequencies[k], WithinRel(single.frequencies[k / 2], 1e-9));
}

TEST_CASE("frequencies scale with units and do not depend on position", "[model][modal]") {
  const Mesh<Tet4> mesh = jittered(box_tet4({0.1, 0.2, 0.3}, {2, 2, 3}), 0.01, {0.1, 0.2, 0.3});
  const VectorX f = natural_frequencies(make_body(mesh, liver), {}, 6).frequencies;
  const auto same = [&](Mesh<Tet4> other, LinearElastic m, double factor) {
    const VectorX g = natural_frequencies(make_body(std::move(other), m), {}, 6).frequencies;
    return (g / factor - f).cwiseAbs().maxCoeff() / f[0];
  };
  Mesh<Tet4> micrometres = mesh, far = mesh;
  for (Vector3& x : micrometres.positions) x *= 1e-6;
  for (Vector3& x : far.positions) x += Vector3(64, -128, 32);
  CHECK(same(micrometres, liver, 1e6) <= 1e-9);
  CHECK(same(far, liver, 1.0) <= 1e-8);
  LinearElastic stiff = liver, dense = liver;
  stiff.youngs_modulus *= 1e9;
  dense.density *= 1e-4;
  CHECK(same(mesh, stiff, std::sqrt(1e9)) <= 1e-9);
  CHECK(same(mesh, dense, 1e2) <= 1e-9);
  CHECK(natural_frequencies(make_body(mesh, liver), {}, 6).frequencies == f);
}

TEST_CASE("difficult cases: slender, nearly incompressible, soft part in a hard body", "[model][modal][extreme]") {
  SECTION("a free rod a hundred times as long as thick") {
    const LinearElastic m{1e6, 0.0, 1000.0};
    const auto modes = natural_frequencies(make_body(box_hex20({1.0, 0.01, 0.01}, {40, 1, 1}), m), {}, 6);
    // (beta L)^2 sqrt(E I / (rho A L^4)) / 2 pi, beta L = 4.730041: in pairs
    const double bending = 4.730041 * 4.730041 * std::sqrt(1e6 * 1e-4 / 12.0 / 1000.0) / (2.0 * pi);
    CHECK_THAT(modes.frequencies[0], WithinRel(bending, 2e-3));
    CHECK_THAT(modes.frequencies[1], WithinRel(modes.frequencies[0], 1e-7));
  }
  SECTION("a Poisson ratio of 0.4999") {
    const LinearElastic m{3e3, 0.4999, 1100.0};
    const auto body = make_body(box_hex20(Vector3::Constant(1.0), {4, 4, 4}), m);
    const VectorX w = reduced(natural_frequencies(body, {}, 11), m, 1.0);
    CHECK((w.array() / (pi * std::sqrt(2.0)) - 1.0).abs().minCoeff() <= 3e-3);
  }
  SECTION("moduli a million apart") {
    Mesh<Tet4> mesh = two_cubes();
    LinearElastic soft = reference_material, hard = reference_material;
    hard.youngs_modulus *= 1e6;
    const auto body = body_of(mesh, {soft, hard});
    const VectorX all = dense_eigenvalues(body, {});
    const auto modes = natural_frequencies(body, {}, 4);
    for (Index k = 0; k < 4; ++k) CHECK_THAT(modes.frequencies[k], WithinRel(std::sqrt(all[6 + k]) / (2.0 * pi), 1e-6));
  }
}

TEST_CASE("rounding is reported, and refused when it dominates", "[model][modal][extreme]") {
  LinearElastic hard = reference_material;
  const auto constrained_with_contrast = [&](double contrast) {
    Mesh<Hex20> mesh = box_hex20({1, 1, 1}, {3, 3, 3});
    mesh.region_names = {"soft", "hard"};
    mesh.regions.assign(27, 0);
    std::fill_n(mesh.regions.begin() + 9, 18, 1);  // the soft layer is at the bottom
    hard.youngs_modulus = contrast * reference_material.youngs_modulus;
    Scene scene;
    scene.fix("z0");
    return natural_frequencies(make_body(mesh, std::vector{reference_material, hard}), scene, 4).rounding;
  };
  CHECK(constrained_with_contrast(1.0) <= 1e-10);
  const double some = constrained_with_contrast(1e8);
  CHECK(some > 1e-10);
  CHECK(some <= 1e-3);
  CHECK_REFUSED(SetupErrorKind::ill_conditioned, constrained_with_contrast(3e12));
  CHECK_REFUSED(SetupErrorKind::not_positive_definite,
                constrained_with_contrast(1e15));  // already refused by the pivots
}

TEST_CASE("two tetrahedra joined at a node are a mechanism", "[model][modal]") {
  Mesh<Tet4> mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.elements = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  const auto modes = natural_frequencies(make_body(mesh, liver), {}, 4);
  CHECK(modes.rigid_modes() == 6);
  CHECK(modes.frequencies.head(3).maxCoeff() <= 1e-6 * modes.frequencies[3]);  // rotations about the node
  CHECK_THAT(modes.frequencies[3],
             WithinRel(std::sqrt(dense_eigenvalues(make_body(mesh, liver), {})[9]) / (2.0 * pi), 1e-9));
}

TEST_CASE("invalid requests for natural frequencies are refused", "[model][modal]") {
  const auto body = make_body(two_cubes(), reference_material);
  CHECK_REFUSED(SetupErrorKind::bad_argument, natural_frequencies(body, {}, 0));
  CHECK_REFUSED(SetupErrorKind::bad_argument, natural_frequencies(body, {}, -3));
  CHECK_REFUSED(SetupErrorKind::count_too_large, natural_frequencies(body, {}, 31));  // 36 dofs, 6 rigid
  CHECK(refusal([&] { natural_frequencies(body, {}, 31); }).threshold == 30.0);
  Scene all_fixed, wrong;
  all_fixed.fix("surface");
  CHECK_REFUSED(SetupErrorKind::count_too_large, natural_frequencies(body, all_fixed, 1));
  wrong.fix("nowhere");
  CHECK_REFUSED(SetupErrorKind::unknown_group, natural_frequencies(body, wrong, 1));

  auto massless = body;
  massless.density.back() = 0.0;
  CHECK(refusal([&] { natural_frequencies(massless, {}, 1); }).ids == std::vector<std::int64_t>{1});
  CHECK_REFUSED(SetupErrorKind::bad_density, natural_frequencies(massless, {}, 1));

  SetupLimits cancelled, small;
  cancelled.progress = [](const Progress& p) { return p.stage != "natural frequencies"; };
  small.memory = 1000;
  CHECK_REFUSED(SetupErrorKind::cancelled, natural_frequencies(body, {}, 3, cancelled));
  CHECK_REFUSED(SetupErrorKind::too_large, natural_frequencies(body, {}, 3, small));
}
