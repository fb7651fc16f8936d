// Example 07: pull a lobe aside.
//
//   example_07_retract [--out DIR]
//
// A surgeon's hook grasps the thin lobe of the organ shipped with palpate and pulls it up and to the middle by 50 mm, a
// quarter of its length. With linear elasticity the lobe would grow as it rotates; this needs large strain.
//
//   1. `Equilibrium` takes mesh, scene and a material per region, here NeoHookean, and finds the equilibrium under
//      constraints and loads: Newton's method on the energy.
//   2. `set_prescribed` moves the nodes in the hook, `step(0.0)` finds the next equilibrium from the last. The material
//      is not viscoelastic, so the time step is zero; 08-relax has a viscoelastic one.
//   3. `reactions` are the forces at constrained nodes, including the hook. The report of every step states whether it
//      converged, whether the equilibrium is stable, and whether elements are inverted.
//   4. DIR/report.html has the force curve and that of linear elasticity; DIR/retract.pvd is a series for ParaView.
//
// The example checks itself: all steps converge, are stable and have no inverted elements, and the work of the hook
// equals the energy stored in the organ. The exit code is 0 when that is true, 1 when it is not, 2 when the mesh or the
// arguments were refused.
#include "../common/main_with_out.hpp"
#include "../common/page.hpp"

#include <palpate/io/pvd.hpp>
#include <palpate/io/read_msh.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/soft.hpp>

#include <iostream>

using namespace palpate;
using touch::text;

namespace {

constexpr int steps = 16;
const Vector3 pull(-0.03, 0.0, 0.04);  // [m]
const RegionMaterials<NeoHookean> materials{
    {"parenchyma", {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}},
    {"lesion", {.youngs_modulus = 50e3, .poisson_ratio = 0.45, .density = 1060.0}},
};

/// The grasped region: all points within 15 mm of the tip of the thin lobe.
where::PointSet hook_at_tip(const Mesh<Tet4>& mesh) {
  return where::sphere(*std::ranges::max_element(mesh.positions, {}, [](const Vector3& x) { return x.x(); }), 0.015);
}

struct Pull {
  std::vector<Vector2> force;       ///< displacement of the hook [mm], its force in that direction [N]
  double work = 0.0, energy = 0.0;  ///< [J]
  int iterations = 0;
  double smallest_volume_ratio = 1.0;
  bool valid = true;  ///< all steps converged, stable, no inverted element
};

/// Pulls in equal steps, and writes a file for each.
Pull retract(const Mesh<Tet4>& mesh, const std::filesystem::path& out) {
  const where::PointSet hook = hook_at_tip(mesh);
  Equilibrium organ(mesh, Scene().fix("ligament").prescribe(hook, {pull[0], pull[1], pull[2]}), materials);
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
    result.valid = result.valid && report.converged && report.stable && report.deformation.inverted == 0;
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
  const auto mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  const Pull p = retract(mesh, out);

  const double end = p.force.back()[0], first = p.force[1][1] / p.force[1][0];  // per mm, of the first step
  touch::Chart chart("force of the hook", touch::from_zero("displacement of the hook [mm]", end),
                     touch::from_zero("force [N]", std::max(p.force.back()[1], first * end)));
  chart.line(p.force, "blue");
  chart.line({{0.0, 0.0}, {end, first * end}}, "grey");
  const double missing = p.work / p.energy - 1.0;
  const example::Figures figures{{"force at the end", text("%.3f N", p.force.back()[1])},
                                 {"with linear elasticity", text("%.3f N", first * end)},
                                 {"work of the hook, energy in the organ",
                                  text("%.3f mJ, %.3f mJ (%+.2f %%)", 1e3 * p.work, 1e3 * p.energy, 100.0 * missing)},
                                 {"steps, iterations", text("%d, %d", steps, p.iterations)},
                                 {"smallest volume ratio of an element", text("%.3f", p.smallest_volume_ratio)}};
  example::write_page(
      out, "Retraction of a lobe",
      "A hook pulls the thin lobe of an organ by 50 mm. The straight line is the stiffness of the first step.",
      {chart.svg()}, figures);
  example::print(figures);
  std::cout << "wrote " << (out / "report.html").string() << " and " << (out / "retract.pvd").string() << '\n';
  if (p.valid && std::abs(missing) < 0.01) return 0;
  std::cerr << "a step did not converge, was unstable or had inverted elements, or the work differs from the energy\n";
  return 1;
}

}  // namespace

int main(int count, char** values) {
  return example::main_with_out(count, values, "build/retract", run_example);
}
