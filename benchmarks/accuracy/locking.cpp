// Near incompressibility: accuracy of plain elements, which lock, and of elements with a treatment of locking.
#include "elements.hpp"
#include "parts.hpp"

namespace accuracy {

namespace {

struct Measured {
  double value = 0.0, seconds = 0.0;  ///< seconds: time of assembly and factorisation
  Index nodes = 0;
};

/// A beam 4 x 1 x 1, clamped at x = 0, E = 1, with a shear traction of 1e-3 at its end: mean deflection.
template <Element E>
Measured deflect(int across, double nu) {
  const Scene scene = Scene().fix("x0").traction("x1", {0.0, 0.0, -1e-3});
  const Body<E> body = body_of(box_of<E>({4, 1, 1}, {4 * across, across, across}), {{1.0, nu, 0.0}});
  const Solved solved = solve(body, scene);
  return {mean_displacement(body, scene, solved, 1e-3), solved.seconds, body.mesh.node_count()};
}

/// A unit cube bonded at bottom and top and compressed by 0.01: the force for E = 1. `quarter` solves a quarter of it,
/// with two planes of symmetry.
template <Element E>
Measured press(int n, double nu, bool quarter = false) {
  Scene scene = Scene().fix("z0").prescribe("z1", {0.0, 0.0, -0.01});
  if (quarter)
    scene.prescribe("x0", {0.0, std::nullopt, std::nullopt}).prescribe("y0", {std::nullopt, 0.0, std::nullopt});
  const double half = quarter ? 0.5 : 1.0;
  const int across = quarter ? n / 2 : n;
  const Body<E> body = body_of(box_of<E>({half, half, 1.0}, {across, across, n}), {{1.0, nu, 0.0}});
  const Solved solved = solve(body, scene);
  double force = 0.0;
  for (const NodeId i : body.mesh.find_group("z0")->nodes) force += solved.reactions[3 * Index{i} + 2];
  return {force / (half * half), solved.seconds, body.mesh.node_count()};
}

constexpr std::array ratios{0.3, 0.45, 0.49, 0.499, 0.4999};

/// One row: signed errors for all ratios, and the time of the last set-up.
template <Element E, class Measure>
std::vector<double> sweep(int n, const std::array<double, 5>& exact, Table& table, Measure measure) {
  std::vector<double> errors;
  Measured last;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    last = measure(n, ratios[i]);
    errors.push_back(last.value / exact[i] - 1.0);
  }
  std::vector<std::string> row{element_name<E>(), std::to_string(n), std::to_string(last.nodes)};
  for (const double e : errors) row.push_back(percent(e));
  row.push_back(text(last.seconds));
  table.add(std::move(row));
  return errors;
}

/// Expected result: treated and second-order elements stay accurate; plain linear elements do not at 0.4999.
template <Element E>
void judge(const std::vector<double>& errors, double allowed, Checks& checks) {
  if constexpr (E::order == 1 && requires { requires E::locking_poisson_ratio < 0.49; }) {
    checks.expect(std::abs(errors.back()) > 0.5, element_name<E>() + " no longer locks: has the element changed?");
  } else {
    for (const double e : errors) checks.expect(std::abs(e) < allowed, element_name<E>() + ": locks");
  }
}

void bend(Checks& checks) {
  std::printf(
      "### Clamped beam 4 x 1 x 1\n\nError of the deflection [%%] against 0.2636, 0.2584, 0.2564, 0.2559, 0.2558 "
      "(Taylor-Hood elements, +-0.3 %%). n cells across; time: assembly and factorisation.\n\n");
  Table table({"element", "n", "nodes", "0.3", "0.45", "0.49", "0.499", "0.4999", "set-up [s]"});
  each_element([&]<class E>(std::type_identity<E>) {
    std::vector<double> errors;
    for (const int n : {4, 8})
      errors = sweep<E>(cells<E>(n), {0.2636, 0.2584, 0.2564, 0.2559, 0.2558}, table, deflect<E>);
    judge<E>(errors, 0.07, checks);
  });
  table.print();
}

void compress(Checks& checks) {
  std::array<double, 5> exact{};
  double doubt = 0.0;
  for (std::size_t i = 0; i < ratios.size(); ++i) {  // the error of the treated brick is proportional to h
    using Treated = MeanDilatation<Hex8>;
    const double coarse = press<Treated>(16, ratios[i], true).value, fine = press<Treated>(32, ratios[i], true).value;
    exact[i] = 2.0 * fine - coarse;
    doubt = std::max(doubt, std::abs(fine / exact[i] - 1.0));
  }
  std::printf(
      "### Bonded block\n\nA cube fixed at the bottom, its top moved down and fixed laterally. Error of the force [%%] "
      "against MeanDilatation<Hex8> on 16^3 and 32^3 cells, extrapolated (the last step is %.2g %%): %.5f, %.5f, "
      "%.5f, %.5f, %.5f for E = 1 and 1 %% of compression.\n\n",
      100.0 * doubt, exact[0], exact[1], exact[2], exact[3], exact[4]);
  checks.expect(doubt < 0.01, "the reference force of the bonded block has not converged");
  Table table({"element", "n", "nodes", "0.3", "0.45", "0.49", "0.499", "0.4999", "set-up [s]"});
  each_element([&]<class E>(std::type_identity<E>) {
    std::vector<double> errors;
    for (const int n : {4, 8})
      errors = sweep<E>(cells<E>(n), exact, table, [](int m, double nu) { return press<E>(m, nu); });
    judge<E>(errors, 0.12, checks);
  });
  table.print();
}

}  // namespace

void locking(Checks& checks) {
  std::printf("## Locking\n\n");
  bend(checks);
  compress(checks);
}

}  // namespace accuracy
