// Whole models, from mesh to the first tick: compared with figures of 1999 and 2004, and on an organ.
#include "../common/bodies.hpp"
#include "setup.hpp"

#include <palpate/io/read_mesh.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <memory>

namespace setup {
namespace {

using namespace palpate;
using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

struct Measured {
  double cpu;  ///< median [s]
  std::unique_ptr<Model> model;
};

Measured set_up(const Mesh<Tet4>& mesh, const Scene& scene) {
  Measured m{0.0, nullptr};
  m.cpu = bench::median_seconds([&] { m.model = std::make_unique<Model>(mesh, scene, bench::tissue); });
  return m;
}

/// Error of the stored compliance of a vertex relative to a solve for all dofs; empty when small.
std::string compliance_error(Model& model) {
  const int v = static_cast<int>(model.touchable_nodes().size() / 2);
  VectorX u(3 * model.mesh().node_count());
  const VertexForce force{v, {1e-3, -2e-3, 3e-3}};
  model.displacement_with({&force, 1}, u);
  const Vector3 solved = u.segment<3>(3 * Index{model.touchable_nodes()[static_cast<std::size_t>(v)]});
  const Vector3 stored = model.compliance(v, v) * force.force.in_model_axes();
  return error_over((solved - stored).norm() / solved.norm(), 1e-10, "stored compliance differs from a solve:");
}

/// A block of `cells`, fixed at the bottom. `all`: its whole free surface is touchable, otherwise only its top.
void measure_seed(Session& session, std::array<int, 3> cells, bool all, double past_seconds, const char* past,
                  double target) {
  const Mesh<Tet4> mesh = box_tet4(Vector3(0.1, 0.1, 0.05), cells, BoxSplit::six);
  std::vector<NodeId> touched = mesh.find_group("z1")->nodes;
  if (all)
    for (const char* side : {"x0", "x1", "y0", "y1"})
      for (NodeId i : mesh.find_group(side)->nodes)
        if (mesh.position(i).z() > 1e-9 && std::ranges::find(touched, i) == touched.end()) touched.push_back(i);
  Scene scene;
  scene.fix("z0").touch(touched);
  const Measured m = set_up(mesh, scene);
  session.rows.add({.target = "seeds",
                    .what = "model of " + std::to_string(mesh.node_count()) + " nodes, touchable " +
                            (all ? "everywhere: " : "on top: ") + std::to_string(touched.size()) + "; allowed " +
                            bench::milliseconds(target),
                    .figure = bench::milliseconds(m.cpu),
                    .baseline = past + (", " + bench::with_unit(past_seconds / m.cpu, "times longer")),
                    .ratio = m.cpu / target,
                    .bound = bench::at_most(1.0),
                    .error = compliance_error(*m.model)});
}

void measure_body(Session& session, const Mesh<Tet4>& mesh, const Scene& scene, const std::string& name) {
  const Measured m = set_up(mesh, scene);
  const SetupReport& r = m.model->report();
  std::string stages;
  for (const auto& [stage, seconds] : r.seconds)
    stages += (stages.empty() ? "" : ", ") + stage + ' ' + bench::milliseconds(seconds);
  session.rows.add({.target = "model",
                    .what = name + ", " + std::to_string(r.elements) + " tets, " +
                            std::to_string(r.touchable_vertices) + " touchable nodes",
                    .figure = bench::milliseconds(m.cpu),
                    .baseline = stages,
                    .bound = {},
                    .error = compliance_error(*m.model)});
}

}  // namespace

void measure_models(Session& session, const char* organ_file) {
  for (const bool all : {false, true}) {
    measure_seed(session, {7, 5, 3}, all, 7 * 60.0, "7 min for 193 (1999)", 3e-3);
    measure_seed(session, {12, 7, 5}, all, 4 * 60.0, "over 4 min for 624 (2004)", 25e-3);
  }
  for (const int n : {10, 16}) {
    const bench::SupportedBody block = bench::standard_block(n);
    measure_body(session, block.mesh, block.scene(), at_size("block", n));
  }
  Scene scene;
  scene.fix("ligament").touch("front");
  measure_body(session, io::read_mesh<Tet4>(organ_file), scene, "organ.msh");
}

}  // namespace setup
