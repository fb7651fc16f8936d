// Benchmark problems with closed forms, converged values or published targets.
#include "elements.hpp"
#include "lame_sphere.hpp"
#include "le10.hpp"
#include "parts.hpp"

#include <palpate/post/error_estimate.hpp>

#include <Eigen/LU>

namespace accuracy {

namespace {

std::string count(Index n) {
  return std::to_string(n);
}

/// Energy norm of the true stress error.
template <Element E>
double true_error(const Body<E>& body, const VectorX& u, const LameSphere& sphere) {
  const Matrix6 compliance = body.elasticity.front().inverse();
  const detail::ElementStress<E> state(body, u);
  double square = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e)
    for (const detail::StressPoint& point : state.template points<typename E::MassQuadrature>(e)) {
      const Vector6 missed = sphere.stress(point.position) - point.stress;
      square += point.volume * missed.dot(compliance * missed);
    }
  return std::sqrt(square);
}

template <Element E>
void solve_sphere(double nu, Table& table, Checks& checks) {
  LameSphere sphere;
  sphere.material.poisson_ratio = nu;
  double before = infinity, effectivity = 0.0;
  for (const int n : {cells<E>(4), cells<E>(8), cells<E>(12)}) {
    const Body<E> body = body_of(sphere_octant<E>(sphere.a, sphere.b, n, n), {sphere.material});
    const VectorX u = solve(body, sphere.scene()).displacement;
    double worst = 0.0, worst_stress = 0.0;
    const NodalStress nodal = patch_recovery(body, u);
    for (Index i = 0; i < body.mesh.node_count(); ++i) {
      const Vector3& x = body.mesh.position(i);
      worst =
          std::max(worst, (u.segment<3>(3 * i) - sphere.displacement(x)).norm() / sphere.radial_displacement(sphere.a));
      worst_stress = std::max(worst_stress, (nodal.at(i) - sphere.stress(x)).cwiseAbs().maxCoeff() / sphere.p);
    }
    const ErrorEstimate estimate = estimate_error(body, u, nodal);
    const double exact = true_error(body, u, sphere);
    effectivity = estimate.error / exact;
    table.add({element_name<E>(), text(nu), count(n), count(body.mesh.node_count()), percent(worst),
               percent(worst_stress), percent(exact / std::hypot(estimate.energy_norm, exact)),
               percent(estimate.relative()), text(effectivity, "%.2f")});
    checks.expect(worst < before, element_name<E>() + ", nu " + text(nu) + ": the sphere does not converge");
    before = worst;
  }
  if (nu < 0.4)
    checks.expect(effectivity > 0.8 && effectivity < (E::nodes == 20 ? 1.8 : 1.25),
                  element_name<E>() + ": effectivity of the estimate");
}

void sphere(Checks& checks) {
  std::printf(
      "## Hollow sphere under internal pressure (Lame)\n\nAn eighth, a = 1, b = 2, three blocks with n cells per side, "
      "n through the wall. Largest nodal errors: displacement relative to u(a), recovered stress relative to p; then "
      "the error in the energy norm, true and estimated (Zienkiewicz and Zhu), in %%.\n\n");
  Table table(
      {"element", "nu", "n", "nodes", "displacement [%]", "stress [%]", "energy [%]", "estimated [%]", "effectivity"});
  for (const double nu : {0.3, 0.499})
    each_element([&]<class E>(std::type_identity<E>) { solve_sphere<E>(nu, table, checks); });
  table.print();
}

/// 1 x 0.2 x 0.2 m, E = 1 MPa, nu = 0.3, transverse force of 4 N at its end.
template <Element E>
void solve_cantilever(Table& table, Checks& checks) {
  constexpr double converged = 0.0101745, size = 0.2, force = 4.0;
  const Scene scene = Scene().fix("x0").traction("x1", {0.0, 0.0, -force / (size * size)});
  double last = 0.0;
  for (const int n : {cells<E>(2), cells<E>(4), cells<E>(8)}) {
    const Body<E> body = body_of(box_of<E>({1.0, size, size}, {5 * n, n, n}), {{1e6, 0.3, 0.0}});
    const double tip = mean_displacement(body, scene, solve(body, scene), force);
    table.add({element_name<E>(), times(5 * n, n, n), count(body.mesh.node_count()), text(tip, "%.8f"),
               percent(tip / converged - 1.0)});
    // Results of two other codes, which agree to seven digits.
    const auto agrees = [&](double reference) {
      checks.expect(std::abs(tip / reference - 1.0) < 1e-6,
                    element_name<E>() + ": differs from the reference value of this mesh");
    };
    if (std::same_as<E, Hex8> && n == 2) agrees(0.00882890013);
    if (std::same_as<E, Hex8> && n == 4) agrees(0.00976842);
    if constexpr (detail::HasSmoothedStrain<E>) {  // not a minimum of the energy: it may converge from either side
      checks.expect(std::abs(tip - converged) < std::abs(last - converged), element_name<E>() + ": does not converge");
    } else {
      checks.expect(tip > last, element_name<E>() + ": the deflection does not grow with refinement");
      checks.expect(tip < 1.002 * converged, element_name<E>() + ": deflection above the converged value");
    }
    last = tip;
  }
}

void cantilever(Checks& checks) {
  std::printf(
      "## Cantilever\n\n1 x 0.2 x 0.2 m, clamped, nu = 0.3. Mean deflection of the loaded end, converged in three "
      "dimensions to 0.0101745 m (beam theory, in which the clamped end may contract, gives 0.01031).\n\n");
  Table table({"element", "cells", "nodes", "deflection [m]", "error [%]"});
  each_element([&]<class E>(std::type_identity<E>) { solve_cantilever<E>(table, checks); });
  table.print();
}

/// Plane strain: both faces are constrained in z.
template <Element E>
void solve_cook(double nu, double converged, Table& table, Checks& checks) {
  const Scene scene = Scene()
                          .fix("x0")
                          .prescribe("z0", {std::nullopt, std::nullopt, 0.0})
                          .prescribe("z1", {std::nullopt, std::nullopt, 0.0})
                          .traction("x1", {0.0, 6.25, 0.0});
  double error = 0.0;
  for (const int n : {4, 8, 16}) {  // the reference meshes, the same cells for both orders
    const Body<E> body = body_of(cook_membrane<E>(n, n / 4), {{240.565, nu, 0.0}});
    const double tip = mean_displacement(body, scene, solve(body, scene), 6.25 * 16.0 * 5.0);
    error = tip / converged - 1.0;
    table.add({element_name<E>(), text(nu, "%.4f"), times(n, n, n / 4), count(body.mesh.node_count()),
               text(tip, "%.4f"), percent(error)});
    const auto agrees = [&](double reference) {
      checks.expect(std::abs(tip / reference - 1.0) < 2e-4,
                    element_name<E>() + ": differs from the reference value of this mesh");
    };
    if (std::same_as<E, Hex8> && n == 8) agrees(nu < 0.4 ? 8.134 : nu < 0.4995 ? 2.701 : 2.225);
  }
  if constexpr (E::order == 2 || detail::HasMeanDilatation<E>)
    checks.expect(std::abs(error) < 0.05,
                  element_name<E>() + ", nu " + text(nu) + ": error above 5 % on Cook's membrane");
}

void cook(Checks& checks) {
  std::printf(
      "## Cook's membrane, plane strain\n\nMean displacement of the loaded edge; converged values: 8.974, 7.727, "
      "7.718.\n\n");
  Table table({"element", "nu", "cells", "nodes", "displacement", "error [%]"});
  constexpr std::array ratios{1.0 / 3.0, 0.499, 0.4999}, converged{8.974, 7.727, 7.718};
  for (std::size_t i = 0; i < ratios.size(); ++i)
    each_element([&]<class E>(std::type_identity<E>) { solve_cook<E>(ratios[i], converged[i], table, checks); });
  table.print();
}

template <Element E>
void solve_le10(Table& table, Checks& checks) {
  double error = 0.0;
  for (const auto& [around, outwards, through] : {std::array{6, 4, 2}, std::array{12, 8, 4}, std::array{24, 16, 8}}) {
    if (E::order == 2 && around == 24) continue;
    const Body<E> body = body_of(elliptic_plate<E>({around, outwards, through}), {le10_steel});
    const VectorX u = solve(body, le10_scene()).displacement;
    const double stress = le10_stress(body, u);
    error = stress / le10_target - 1.0;
    table.add({element_name<E>(), times(around, outwards, through), count(body.mesh.node_count()),
               text(1e-6 * stress, "%.3f"), percent(error), percent(estimate_error(body, u).relative())});
  }
  checks.expect(std::abs(error) < (E::order == 2 ? 0.07 : 0.1), element_name<E>() + ": LE10");
}

void le10(Checks& checks) {
  std::printf(
      "## NAFEMS LE10\n\nsigma_yy at D, by patch recovery; the target is -5.38 MPa. The line support is singular: "
      "fine meshes converge to about -5.42. Other codes: Hex20 -5.470 and -5.483 on such meshes, Tet10 -5.48 "
      "... -5.40.\n\n");
  Table table({"element", "cells", "nodes", "sigma_yy [MPa]", "error [%]", "estimated error, energy norm [%]"});
  each_element([&]<class E>(std::type_identity<E>) { solve_le10<E>(table, checks); });
  table.print();
}

}  // namespace

void benchmark_problems(Checks& checks) {
  sphere(checks);
  cantilever(checks);
  cook(checks);
  le10(checks);
}

}  // namespace accuracy
