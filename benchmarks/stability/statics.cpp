// The sweep over materials, element qualities and solvers of statics.
#include "statics.hpp"

#include <cstdio>
#include <fstream>
#include <functional>

namespace maps {
namespace {

std::string short_number(double v) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", v);
  return text.data();
}

struct Named {
  std::string name;
  double value;
};
const std::vector<Named> ratios{{"-0.9", -0.9},
                                {"0", 0.0},
                                {"0.3", 0.3},
                                {"0.45", 0.45},
                                {"0.49", 0.49},
                                {"0.499", 0.499},
                                {"0.4999", 0.4999},
                                {"0.5(1-1e-6)", 0.5 * (1.0 - 1e-6)},
                                {"0.5(1-1e-10)", 0.5 * (1.0 - 1e-10)}};
const std::vector<Named> qualities{{"regular", 1.0}, {"flat 1e-1", 1e-1}, {"flat 1e-3", 1e-3}, {"flat 1e-6", 1e-6}};

/// Cube of 0.1 m, soft where it is fixed and `contrast` times as stiff where it is loaded. One layer of cells across
/// both materials is flattened to `height` of its original height.
StaticProblem block(int cells, double nu, double contrast, double height) {
  std::vector<double> even, layered;
  for (int i = 0; i <= cells; ++i) {
    even.push_back(0.1 * i / cells);
    layered.push_back(0.1 * (i <= cells / 2 ? i : i - 1 + height) / cells);
  }
  StaticProblem p;
  p.mesh = box_tet4(even, even, layered, BoxSplit::six);
  p.mesh.region_names = {"soft", "hard"};
  p.mesh.regions.clear();
  for (Index e = 0; e < p.mesh.element_count(); ++e)
    p.mesh.regions.push_back(element_nodes<Tet4>(p.mesh, e).col(0).mean() < 0.05 ? 0 : 1);
  p.materials = {{1e3, nu, 1000.0}, {contrast * 1e3, nu, 1000.0}};
  p.constrained = p.mesh.find_group("x0")->nodes;
  p.pulled = p.mesh.find_group("x1")->nodes;
  for (NodeId node : p.mesh.find_group("z1")->nodes)  // a strip across both materials
    if (p.mesh.position(node).y() > 0.049 && p.mesh.position(node).y() < 0.051 + 0.1 / cells) p.touched.push_back(node);
  return p;
}

std::string tip_of(const StaticCell& c) {
  std::string tip =
      c.solver->name + ", nu " + c.nu + ", contrast " + c.contrast + ", " + c.quality + ": " + name(c.verdict);
  if (!c.answer.refused) tip += ", error " + short_number(c.error);
  if (c.answer.flagged) tip += ", estimate " + short_number(c.answer.estimate);
  return c.answer.why.empty() ? tip : tip + "; " + c.answer.why;
}

class Sweep {
 public:
  Sweep(const std::string& folder) : csv_(folder + "/statics.csv") {
    csv_ << "whose,solver,elements,nu,contrast,verdict,error,bound,estimate,worst_quality,remark\n";
  }

  Square add(const StaticCell& c) {
    (c.solver->ours ? score.ours : score.others)[c.solver->name].add(c.verdict);
    std::string remark = c.answer.why;
    for (char& letter : remark)
      if (letter == '"') letter = '\'';
    csv_ << (c.solver->ours ? "palpate" : "other") << ",\"" << c.solver->name << "\"," << c.quality << ',' << c.nu
         << ',' << c.contrast << ',' << name(c.verdict) << ',' << c.error << ',' << c.solver->bound << ','
         << c.answer.estimate << ',' << c.answer.quality << ",\"" << remark << "\"\n";
    if (c.verdict == Verdict::wrong && c.solver->ours) std::printf("WRONG %s\n", tip_of(c).c_str());
    return {c.verdict, shade_of_error(c.error), tip_of(c)};
  }

  Score score;

 private:
  std::ofstream csv_;
};

/// Runs all solvers on one problem.
void solve_all(const StaticProblem& problem, const std::vector<StaticSolver>& solvers, StaticCell cell,
               const std::function<void(std::size_t, const StaticCell&)>& take) {
  const Truth truth(problem);
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    cell.solver = &solvers[s];
    cell.error = std::numeric_limits<double>::quiet_NaN();
    cell.answer = solvers[s].solve(problem);
    cell.verdict = judge(solvers[s], cell.answer, truth, cell.error);
    take(s, cell);
  }
}

/// Problems without a solution: every result is wrong.
struct Defect {
  std::string name;
  std::function<void(StaticProblem&)> make;
};
std::vector<Defect> defects() {
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  const auto poisson = [](double nu) {
    return [nu](StaticProblem& p) {
      for (LinearElastic& m : p.materials) m.poisson_ratio = nu;
    };
  };
  return {{"nu 0.5", poisson(0.5)},
          {"nu 0.6", poisson(0.6)},
          {"nu -1", poisson(-1.0)},
          {"E negative", [](StaticProblem& p) { p.materials[0].youngs_modulus *= -1.0; }},
          {"E infinite", [](StaticProblem& p) { p.materials[1].youngs_modulus = infinity; }},
          {"no node fixed", [](StaticProblem& p) { p.constrained.clear(); }},
          {"one node fixed", [](StaticProblem& p) { p.constrained.resize(1); }},
          {"two nodes fixed", [](StaticProblem& p) { p.constrained.resize(2); }},
          {"element inverted", [](StaticProblem& p) { std::swap(p.mesh.elements[7][0], p.mesh.elements[7][1]); }},
          {"element flat",
           [](StaticProblem& p) {
             const auto& e = p.mesh.elements.back();
             p.mesh.positions[static_cast<std::size_t>(e[3])] =
                 (p.mesh.position(e[0]) + p.mesh.position(e[1]) + p.mesh.position(e[2])) / 3.0;
           }},
          {"nodes coincide",
           [](StaticProblem& p) {
             const auto& e = p.mesh.elements.back();
             p.mesh.positions[static_cast<std::size_t>(e[3])] = p.mesh.position(e[0]);
           }},
          {"position NaN", [nan](StaticProblem& p) { p.mesh.positions[30][1] = nan; }},
          {"a disconnected part", [](StaticProblem& p) {
             const auto first = static_cast<NodeId>(p.mesh.node_count());
             for (const Vector3& x : {Vector3(1, 0, 0), Vector3(1.1, 0, 0), Vector3(1, 0.1, 0), Vector3(1, 0, 0.1)})
               p.mesh.positions.push_back(x);
             p.mesh.elements.push_back({first, first + 1, first + 2, first + 3});
             p.mesh.regions.push_back(0);
           }}};
}

/// Without the reference, which cannot detect all of these problems because of rounding.
void measure_defects(int cells, const std::vector<StaticSolver>& solvers, Sweep& sweep, StaticMap& map) {
  Grid grid{.title = "Input without a solution", .columns = {}, .rows = {}, .squares = {}};
  const std::vector<Defect> all = defects();
  for (const Defect& d : all) grid.columns.push_back(d.name);
  for (const StaticSolver& s : solvers) {
    grid.rows.push_back(s.name);
    for (const Defect& d : all) {
      StaticProblem problem = block(cells, 0.3, 1.0, 1.0);
      d.make(problem);
      StaticCell cell{.solver = &s, .quality = d.name, .nu = "", .contrast = "", .answer = s.solve(problem)};
      cell.verdict = cell.answer.refused ? Verdict::refused : Verdict::wrong;
      grid.squares.push_back(sweep.add(cell));
    }
  }
  map.defects = {std::move(grid)};
}

}  // namespace

StaticMap measure_statics(int cells, const std::string& folder) {
  std::vector<StaticSolver> solvers = our_solvers();
  for (const StaticSolver& s : plain_solvers()) solvers.push_back(s);
  Sweep sweep(folder);
  StaticMap map;
  std::vector<Grid> grids(solvers.size() * qualities.size());
  std::vector<std::string> columns, rows;
  for (const Named& nu : ratios) columns.push_back(nu.name);
  for (int decade = 0; decade <= 9; ++decade) rows.push_back(decade == 0 ? "1" : "1e" + std::to_string(decade));
  for (std::size_t q = 0; q < qualities.size(); ++q) {
    for (std::size_t s = 0; s < solvers.size(); ++s)
      grids[s * qualities.size() + q] = {
          .title = solvers[s].name + ", " + qualities[q].name, .columns = columns, .rows = rows, .squares = {}};
    for (int decade = 0; decade <= 9; ++decade)
      for (const Named& nu : ratios)
        solve_all(block(cells, nu.value, std::pow(10.0, decade), qualities[q].value), solvers,
                  {.quality = qualities[q].name,
                   .nu = nu.name,
                   .contrast = rows[static_cast<std::size_t>(decade)],
                   .answer = {}},
                  [&](std::size_t s, const StaticCell& c) {
                    grids[s * qualities.size() + q].squares.push_back(sweep.add(c));
                  });
    std::printf("statics: %s done\n", qualities[q].name.c_str());
    std::fflush(stdout);
  }
  measure_defects(cells, solvers, sweep, map);
  for (std::size_t s = 0; s < solvers.size(); ++s)
    for (std::size_t q = 0; q < qualities.size(); ++q)
      (solvers[s].ours ? map.ours : map.others).push_back(std::move(grids[s * qualities.size() + q]));
  map.score = std::move(sweep.score);
  return map;
}

}  // namespace maps
