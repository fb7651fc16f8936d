#pragma once

#include "properties/element_cases.hpp"

#include <numeric>

/// Extremes of material and mesh for any element, compared with fields whose nodal values are known. Each element is
/// compiled in its own file.
namespace test {

/// Checks the error of a model; an error above the bound must have been flagged by the report.
template <class Model>
void judge_element(const Model& model, double error, double bound) {
  const SetupReport& report = model.report();
  INFO("error " << error << ", probe " << report.probe_error);
  CHECK(error <= (report.has(SetupFlag::ill_conditioned) ? std::max(bound, 100.0 * report.probe_error) : bound));
}

/// An affine field prescribed on the boundary: nodal values are known for every material and every shape of
/// straight-sided elements. Refusals are counted.
template <Element E>
int judge_affine(const Mesh<E>& mesh, const LinearElastic& material, double bound, int& flagged) {
  Matrix3 a;
  a << 0.01, 0.02, -0.01, 0.03, -0.02, 0.03, 0.01, 0.0, 0.02;
  const Vector3 centre = mesh.position(0);
  const auto field = [&](const Vector3& x) -> Vector3 { return a * (x - centre); };
  try {
    const StaticModel<E> model(mesh, prescribe_boundary(mesh, field), material);
    judge_element(model, worst_error(model, mesh, field), bound);
    flagged += model.report().has(SetupFlag::poor_quality) ? 1 : 0;
    return 0;
  } catch (const SetupError& error) {
    const auto kind = error.kind();
    INFO(error.what());
    CHECK((kind == SetupErrorKind::ill_conditioned || kind == SetupErrorKind::not_positive_definite ||
           kind == SetupErrorKind::poor_quality || kind == SetupErrorKind::degenerate_element ||
           kind == SetupErrorKind::duplicate_node));
    return 1;
  }
}

/// A body of two materials stretched along x without lateral contraction: strains jump at the interface and are exact.
template <Element E>
void check_contrast(double contrast) {
  Mesh<E> mesh = box_of<E>({0.1, 0.05, 0.05}, {4, 2, 2});
  mesh.region_names = {"soft", "hard"};
  mesh.regions.clear();
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.regions.push_back(element_nodes<E>(mesh, e).col(0).mean() < 0.05 ? 0 : 1);
  const RegionMaterials<LinearElastic> materials{{"soft", {1e3, 0.0, 0.0}}, {"hard", {contrast * 1e3, 0.0, 0.0}}};
  const double stress = 20.0;
  const Scene scene = Scene()
                          .prescribe("x0", {0.0, std::nullopt, std::nullopt})
                          .prescribe("y0", {std::nullopt, 0.0, std::nullopt})
                          .prescribe("z0", {std::nullopt, std::nullopt, 0.0})
                          .traction("x1", {stress, 0.0, 0.0});
  const auto field = [&](const Vector3& x) -> Vector3 {
    const double soft = std::min(x[0], 0.05), hard = x[0] - soft;
    return {stress / 1e3 * (soft + hard / contrast), 0.0, 0.0};
  };
  try {
    const StaticModel<E> model(mesh, scene, materials);
    judge_element(model, worst_error(model, mesh, field), 1e-5);
  } catch (const SetupError& error) {
    CHECK(contrast > 1e9);
    CHECK((error.kind() == SetupErrorKind::ill_conditioned || error.kind() == SetupErrorKind::not_positive_definite));
  }
}

/// A beam under its weight; displacement of its nodes.
template <Element E>
VectorX sagging(const Mesh<E>& mesh, const LinearElastic& material) {
  return StaticModel<E>(mesh, Scene().fix("x0").gravity({0, 0, -10.0}), material).displacement();
}

/// A2 A3 B1 B2: Poisson ratios up to the last digit below one half, any modulus, size and position.
template <Element E>
void check_material_extremes() {
  int flagged = 0;
  const Mesh<E> mesh = shaken(box_of<E>({0.1, 0.08, 0.06}, {3, 2, 2}), 0.0015, true);
  for (double nu : {0.49, 0.4999, 0.499999, 0.5 * (1 - 1e-10), std::nextafter(0.5, 0.0), -0.9, -0.9999}) {
    const int refused = judge_affine(mesh, LinearElastic{5e3, nu, 0.0}, 1e-5, flagged);
    if (nu == 0.4999 || nu == -0.9) CHECK(refused == 0);
  }
  for (double young : {1.0, 1e12}) CHECK(judge_affine(mesh, LinearElastic{young, 0.3, 0.0}, 1e-12, flagged) == 0);
  for (double contrast : {1e3, 1e6, 1e9, 1e12}) check_contrast<E>(contrast);

  const LinearElastic tissue{5e3, 0.3, 1000.0};
  const VectorX truth = sagging<E>(mesh, tissue);
  for (double scale : {1e-6, 1e-3, 10.0}) {
    Mesh<E> scaled = mesh;
    for (Vector3& x : scaled.positions) x *= scale;
    CHECK(largest(sagging<E>(scaled, tissue) / (scale * scale) - truth) <= 1e-11 * largest(truth));
  }
  for (double young : {5.0, 5e12})
    CHECK(largest(sagging<E>(mesh, {young, 0.3, 1000.0}) * (young / 5e3) - truth) <= 1e-12 * largest(truth));
  Mesh<E> far = mesh;
  for (Vector3& x : far.positions)
    x += Vector3(100.0, -50.0, 20.0);  // 1000 times its size: 1e-13 of the precision is lost
  CHECK(largest(sagging<E>(far, tissue) - truth) <= 1e-10 * largest(truth));
}

/// B5: a layer of flat elements is right, flagged or refused; some are flagged and some refused.
template <Element E>
void check_slivers() {
  int refused = 0, flagged = 0;
  for (double height : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-11}) {
    Mesh<E> mesh = box_of<E>({0.1, 0.08, 0.06}, {3, 2, 3});
    for (Vector3& x : mesh.positions)
      if (x[2] > 0.03) x[2] = x[2] > 0.04 + 1e-9 ? 0.04 + height * (x[2] - 0.04) : x[2];
    refused += judge_affine(mesh, liver, 1e-5, flagged);
  }
  CHECK(flagged >= 2);
  CHECK(refused >= 1);
}

/// B3 B4 B6 B7 B8: invalid bodies are refused with the right error kind.
template <Element E>
void check_defects() {
  const Mesh<E> good = box_of<E>({0.1, 0.08, 0.06}, {3, 2, 2});
  const Scene constrained = Scene().fix("x0");
  const auto refused_as = [&](const Mesh<E>& mesh, const Scene& scene, SetupErrorKind kind) {
    const SetupProblem p = refusal([&] { StaticModel<E>(mesh, scene, liver); });
    INFO(describe(p));
    CHECK(to_string(p.kind) == to_string(kind));
    CHECK(!p.ids.empty());
    CHECK(!p.hint.empty());
  };
  Mesh<E> bad = good;
  for (NodeId i : bad.elements[5]) bad.positions[static_cast<std::size_t>(i)][2] = 0.02;
  CHECK_THROWS_AS(StaticModel<E>(bad, constrained, liver), SetupError);
  bad = good;
  const auto corner = static_cast<std::size_t>(bad.elements[0][0]);
  bad.positions[corner] = bad.position(bad.elements[0][1]);
  refused_as(bad, constrained, SetupErrorKind::duplicate_node);
  bad = good;
  detail::reorient(bad, {3});
  refused_as(bad, constrained, SetupErrorKind::inverted_element);
  bad = good;
  bad.positions[4][1] = std::numeric_limits<double>::quiet_NaN();
  refused_as(bad, constrained, SetupErrorKind::non_finite);
  bad = good;
  bad.elements[2][1] = static_cast<NodeId>(bad.node_count());
  refused_as(bad, constrained, SetupErrorKind::index_out_of_range);
  refused_as(good, Scene(), SetupErrorKind::unconstrained);
  refused_as(good, Scene().prescribe("x0", {0.0, std::nullopt, std::nullopt}), SetupErrorKind::unconstrained);
  refused_as(good, Scene().fix(std::vector<NodeId>{0}), SetupErrorKind::unconstrained);
}

/// B4 B9: inverted elements are repaired to the same body; one element; all nodes fixed; no force.
template <Element E>
void check_small_bodies() {
  const LinearElastic tissue{5e3, 0.3, 1000.0};
  const Mesh<E> good = box_of<E>({0.1, 0.08, 0.06}, {3, 2, 2});
  Mesh<E> inverted = good;
  detail::reorient(inverted, {3, 4});
  SetupOptions repair;
  repair.admission.inverted = Admission::repair;
  const StaticModel<E> repaired(inverted, Scene().fix("x0").gravity({0, 0, -10.0}), tissue, repair);
  CHECK(repaired.report().has(SetupFlag::repaired));
  CHECK(largest(repaired.displacement() - sagging<E>(good, tissue)) <= 1e-13 * largest(repaired.displacement()));

  Mesh<E> one;
  for (int a = 0; a < E::nodes; ++a) {
    one.positions.push_back(0.01 * E::reference_nodes().row(a).transpose());
    one.elements.resize(1);
    one.elements[0][static_cast<std::size_t>(a)] = static_cast<NodeId>(a);
  }
  std::vector<NodeId> face(E::faces[0].begin(), E::faces[0].end());
  const StaticModel<E> single(one, Scene().fix(face).gravity({1, 2, -10.0}), tissue);
  Vector3 weight = Vector3::Zero();
  for (Index i = 0; i < E::nodes; ++i) weight += single.reactions().template segment<3>(3 * i);
  CHECK(largest(weight + 1000.0 * E::reference_volume * 1e-6 * Vector3(1, 2, -10)) <= 1e-12);
  CHECK(single.displacement().norm() > 0.0);

  const StaticModel<E> still(good, Scene().fix("x0").touch("x1"), tissue);
  CHECK(still.displacement().isZero(0.0));
  CHECK(still.strain_energy() == 0.0);
  std::vector<NodeId> all(good.positions.size());
  std::iota(all.begin(), all.end(), 0);
  const StaticModel<E> constrained(good, Scene().fix(all).gravity({0, 0, -10.0}), tissue);
  CHECK(constrained.report().free_dofs == 0);
  CHECK(constrained.displacement().isZero(0.0));
}

template <Element E>
void check_extremes() {
  SECTION("material, size and place") {
    check_material_extremes<E>();
  }
  SECTION("slivers") {
    check_slivers<E>();
  }
  SECTION("defects") {
    check_defects<E>();
  }
  SECTION("small bodies") {
    check_small_bodies<E>();
  }
}

}  // namespace test
