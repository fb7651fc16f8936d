// Example 07: pull a lobe aside.
//
//   example_07_retract [--out DIR]
//
// A surgeon's hook takes the thin lobe of the organ that comes with palpate and pulls it up and to the middle by 50 mm,
// a quarter of the organ's length. Linear elasticity would let the lobe grow as it turns; this needs large strain.
//
//   1. `Equilibrium` takes mesh, scene and a law per region, here NeoHookean, and finds where the body rests under what
//      holds and pulls it: Newton's method on the energy.
//   2. `set_prescribed` moves the nodes in the hook, `step(0.0)` finds the next equilibrium from the last. The body has
//      no memory here, so no time needs to pass; 08-relax has one.
//   3. `reactions` are the forces in the supports, so also of the hook. The report of every step says whether it
//      arrived, whether the equilibrium is stable, and whether elements are inside out.
//   4. DIR/report.html has the curve beside that of linear elasticity, DIR/retract.pvd plays in ParaView.
//
// The example judges itself: all steps arrive, stable and upright, and the work of the hook is the energy that the
// organ stores. The exit code is 0 when that holds, 1 when it does not, 2 when the mesh or the arguments were refused.
#include "../common/main_with_out.hpp"
#include "../common/page.hpp"

#include <palpate/io/pvd.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/soft.hpp>

#include <iostream>

using namespace palpate;
using touch::text;

namespace {

constexpr int steps = 16;
const Vector3 pull(-0.03, 0.0, 0.04);  // [m]
const RegionMaterials<NeoHookean> laws{
    {"parenchyma", {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}},
    {"lesion", {.youngs_modulus = 50e3, .poisson_ratio = 0.45, .density = 1060.0}},
};

/// What the hook holds: all within 15 mm of the tip of the thin lobe.
where::PointSet hook_at_tip(const Mesh<Tet4>& mesh) {
  return where::sphere(*std::ranges::max_element(mesh.positions, {}, [](const Vector3& x) { return x.x(); }), 0.015);
}

struct Pull {
  std::vector<Vector2> force;       ///< way of the hook [mm], its force along the way [N]
  double work = 0.0, energy = 0.0;  ///< [J]
  int iterations = 0;
  double smallest_volume_ratio = 1.0;
  bool fine = true;  ///< all steps arrived, stable, no element inside out
};

/// Pulls in equal steps, and writes a file for each.
Pull retract(const Mesh<Tet4>& mesh, const std::filesystem::path& out) {
  const where::PointSet hook = hook_at_tip(mesh);
  Equilibrium organ(mesh, Scene().fix("ligament").prescribe(hook, {pull[0], pull[1], pull[2]}), laws);
  const std::vector<NodeId> hooked = nodes_within(mesh, hook);
  const VectorX whole = organ.conditions().prescribed;
  std::filesystem::create_directories(out / "vtu");
  io::PvdSeries series((out / "retract.pvd").string());

  Pull result{.force = {{0.0, 0.0}}};
  Vector3 before = Vector3::Zero();
  for (int k = 1; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    organ.set_prescribed(share * whole);
    const EquilibriumReport report = organ.step(0.0);
    result.iterations += report.iterations;
    result.smallest_volume_ratio = std::min(result.smallest_volume_ratio, report.deformation.smallest_volume_ratio);
    result.fine = result.fine && report.converged && report.stable && report.deformation.inverted == 0;
    const VectorX reactions = organ.reactions();
    Vector3 force = Vector3::Zero();
    for (const NodeId i : hooked) force += reactions.segment<3>(3 * Index{i});
    result.work += 0.5 * (force + before).dot(pull) / steps;
    before = force;
    result.force.emplace_back(1e3 * share * pull.norm(), force.dot(pull.normalized()));
    const std::string file = (out / "vtu" / text("retract_%03d.vtu", k)).string();
    io::VtuFields fields;
    fields.at_nodes = {{"displacement [m]", organ.displacement()}};
    io::write_vtu(file, mesh, fields);
    series.add(share, file);
  }
  result.energy = organ.energy();
  return result;
}

int run_example(const std::filesystem::path& out) {
  const auto mesh = io::read_mesh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  const Pull p = retract(mesh, out);

  const double end = p.force.back()[0], first = p.force[1][1] / p.force[1][0];  // per mm, of the first step
  touch::Chart chart("force of the hook", touch::from_zero("way of the hook [mm]", end),
                     touch::from_zero("force [N]", std::max(p.force.back()[1], first * end)));
  chart.line(p.force, "blue");
  chart.line({{0.0, 0.0}, {end, first * end}}, "grey");
  const double missing = p.work / p.energy - 1.0;
  const example::Figures figures{{"force at the end", text("%.3f N", p.force.back()[1])},
                                 {"linear elasticity would say", text("%.3f N", first * end)},
                                 {"work of the hook, energy in the organ",
                                  text("%.3f mJ, %.3f mJ (%+.2f %%)", 1e3 * p.work, 1e3 * p.energy, 100.0 * missing)},
                                 {"steps, iterations", text("%d, %d", steps, p.iterations)},
                                 {"least volume ratio of an element", text("%.3f", p.smallest_volume_ratio)}};
  example::write_page(
      out, "Retraction of a lobe",
      "A hook pulls the thin lobe of an organ by 50 mm. The straight line is the stiffness of the first step.",
      {chart.svg()}, figures);
  example::print(figures);
  std::cout << "wrote " << (out / "report.html").string() << " and " << (out / "retract.pvd").string() << '\n';
  if (p.fine && std::abs(missing) < 0.01) return 0;
  std::cerr << "a step did not arrive upright and stable, or the work is not the energy\n";
  return 1;
}

}  // namespace

int main(int count, char** values) {
  return example::main_with_out(count, values, "build/retract", run_example);
}
