// Time of a cut until it is rendered, compared with computing everything again; every figure is checked against a new
// system.
//   bench_cut [--build <name of the flags>] [--csv <file to add rows to>] [--trace <file for forces>] [--organ]
//   [--long]
// --organ: only the cuts in real time.
#include <palpate/cut/detail/swept_faces.hpp>
#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <Eigen/SparseCholesky>

#include <exception>

#include "../common/row.hpp"
#include "../common/timing.hpp"
#include "organ.hpp"

namespace {

using namespace palpate;

/// The standard block, fixed at the bottom and touched on top: 3 n (n + 1)^2 dofs.
struct Block {
  Mesh<Tet4> mesh;
  Scene scene = Scene().fix("z0").touch("z1").gravity({0.0, 0.0, -9.81});
  std::vector<BoundaryFace> boundary;
  CutPhysics<Tet4> physics;
  CutTopology<Tet4> topology;
  detail::CutSurface<Tet4> surface;
  detail::CutSystem<Tet4> system;

  /// Nodes above the height `kept_above` [m] are kept in addition to the touchable ones: a cuttable region.
  explicit Block(int n, double kept_above = 1.0)
      : mesh(box_tet4({0.1, 0.1, 0.1}, {n, n, n}, BoxSplit::six)),
        boundary(extract_boundary<Tet4>(mesh)),
        physics(make_body(mesh, LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}),
                boundary, scene),
        topology(mesh, resolve_essential(mesh, boundary, scene).constrained),
        surface(topology, boundary, scene),
        system(topology, physics, kept(kept_above)) {}

  std::vector<NodeId> kept(double above) const {
    std::vector<NodeId> nodes = surface.nodes();
    for (NodeId node = 0; node < mesh.node_count(); ++node)
      if (mesh.position(node)[2] > above) nodes.push_back(node);
    detail::sort_unique(nodes);
    return nodes;
  }

  /// Removes the elements nearest to a point.
  CutOrder burn(const Vector3& where, int count) const {
    std::vector<std::pair<double, Index>> by_distance;
    for (Index e = 0; e < mesh.element_count(); ++e)
      by_distance.push_back({(element_nodes<Tet4>(mesh, e).colwise().mean().transpose() - where).norm(), e});
    std::ranges::sort(by_distance);
    CutOrder order;
    for (int k = 0; k < count; ++k) order.remove.push_back(by_distance[static_cast<std::size_t>(k)].second);
    return order;
  }
  /// A slit from the top.
  CutOrder slit(double length, double depth) const {
    const BladeSweep sweep{{0.0501, 0.05 - 0.5 * length, 0.1 - depth},
                           {0.0501, 0.05 + 0.5 * length, 0.1 - depth},
                           {0.0501, 0.05 - 0.5 * length, 0.2},
                           {0.0501, 0.05 + 0.5 * length, 0.2}};
    return {{}, detail::swept_faces(topology, sweep, [&](NodeId node) { return mesh.position(node); })};
  }
};

std::vector<Vector3> positions_of(const std::vector<NodeId>& nodes, const CutTopology<Tet4>& t,
                                  const detail::CutSystem<Tet4>& system) {
  std::vector<Vector3> x;
  for (const NodeId node : nodes)
    x.push_back(t.mesh().position(node) + system.displacement().segment<3>(3 * Index{node}));
  return x;
}

struct Cost {
  double rendered = 0.0, fold = 0.0, rebuilt = 0.0, error = 0.0, read = 0.0, read_folded = 0.0;
  Index rank = 0, added = 0;
};

double largest_difference(const detail::CutSystem<Tet4>& a, const detail::CutSystem<Tet4>& b,
                          const CutTopology<Tet4>& t) {
  const auto x = a.folded_step(), y = b.folded_step();
  double wrong = 0.0, scale = 0.0;
  std::vector<std::pair<Index, Index>> same;
  for (NodeId node = 0; node < t.mesh().node_count(); ++node)
    for (int c = 0; c < 3; ++c)
      if (a.index_of(node, c) >= 0 && b.index_of(node, c) >= 0)
        same.push_back({a.index_of(node, c), b.index_of(node, c)});
  for (const auto& [i, k] : same)
    for (const auto& [j, l] : same) {
      wrong = std::max(wrong, std::abs((*x)(i, j) - (*y)(k, l)));
      scale = std::max(scale, std::abs((*y)(k, l)));
    }
  return wrong / scale;
}

Cost measure(const Block& b, const CutOrder& order, int repeats) {
  std::vector<double> rendered, folds;
  Cost cost;
  for (int i = 0; i < repeats; ++i) {
    CutTopology<Tet4> topology = b.topology;
    detail::CutSurface<Tet4> surface = b.surface;
    detail::CutSystem<Tet4> system = b.system;
    const std::vector<double> bounds(b.surface.nodes().size(), 1.0);
    detail::CutView view;
    const auto contact = [&] {
      ContactSurface made(positions_of(surface.nodes(), topology, system), surface.triangles());
      made.set_materials(detail::contact_materials(b.physics.body, surface.elements()));
      const auto shell = surface.shell(topology);
      made.add_shell(positions_of(shell.others, topology, system), shell.triangles);
      return std::make_shared<detail::CutContact>(system, surface, std::move(made), 4e-3, ContactParameters{}, 1);
    };
    detail::TopologyChange<Tet4> change;
    rendered.push_back(bench::seconds_of([&] {
      change = topology.apply(order);
      surface.update(topology, change);
      const auto step = system.update(topology, change);
      view = {contact(), step};
      view.bound_by(bounds);
    }));
    folds.push_back(bench::seconds_of([&] { system.fold(); }));
    cost.rank = view.step->rank();
    cost.added = system.added();
    if (i > 0) continue;
    std::unique_ptr<detail::CutSystem<Tet4>> fresh;
    cost.rebuilt = bench::seconds_of(
        [&] { fresh = std::make_unique<detail::CutSystem<Tet4>>(topology, b.physics, surface.nodes()); });
    cost.error = largest_difference(system, *fresh, topology);
    double sum = 0.0;
    const auto read = [&](const detail::CutView& v) {
      return bench::median_seconds([&] {
               for (int k = 0; k < 10000; ++k) sum += v.compliance(k * 7 % 97, k * 13 % 89)(0, 0);
             }) /
             10000;
    };
    cost.read = read(view);
    const detail::CutView folded{view.contact, system.folded_step()};
    cost.read_folded = read(folded);
    if (!std::isfinite(sum)) cost.error = infinity;
  }
  cost.rendered = bench::percentile(rendered, 0.5);
  cost.fold = bench::percentile(folds, 0.5);
  return cost;
}

void report(bench::RowFile& rows, const std::string& what, const Cost& c, double limit) {
  const std::string error = c.error <= 1e-10 ? "" : "relative error " + bench::with_unit(c.error, "");
  const std::string size = what + " (rank " + std::to_string(c.rank) + ", " + std::to_string(c.added) + " dofs added)";
  rows.add({.target = "q",
            .what = "cut until rendered: " + size,
            .figure = bench::milliseconds(c.rendered),
            .baseline = limit > 0.0 ? bench::milliseconds(limit) : "",
            .ratio = limit > 0.0 ? c.rendered / limit : bench::unknown,
            .bound = limit > 0.0 ? bench::at_most(1.0) : bench::Bound{},
            .error = error});
  rows.add({.target = "q",
            .what = "new factor and compliance over update: " + what,
            .figure = bench::milliseconds(c.rendered),
            .baseline = bench::milliseconds(c.rebuilt),
            .ratio = c.rebuilt / c.rendered,
            .bound = limit > 0.0 ? bench::at_least(10.0) : bench::Bound{},
            .error = error});
  rows.add({.target = "q",
            .what = "folding into the base, and reading a 3 x 3 block before and after: " + what,
            .figure = bench::milliseconds(c.fold),
            .baseline = bench::with_unit(1e9 * c.read, "ns") + ", " + bench::with_unit(1e9 * c.read_folded, "ns"),
            .bound = {},
            .error = error});
}

/// Only the factorisation by Eigen, without compliance.
void eigen_refactor(bench::RowFile& rows, const Block& b, int n, double rendered) {
  const Body<Tet4> body = make_body(b.mesh, LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45});
  const EssentialConditions conditions = resolve_essential(b.mesh, b.boundary, b.scene);
  const SparseMatrix lower = free_matrix(assemble_stiffness<Tet4>(body, {}), conditions);
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower> llt;
  const double seconds = bench::seconds_of([&] { llt.compute(lower); });
  const VectorX x = VectorX::Ones(lower.rows()), load = lower.selfadjointView<Eigen::Lower>() * x;
  const double wrong = (llt.solve(load) - x).cwiseAbs().maxCoeff();
  rows.add({.target = "q",
            .what = "Eigen's factorisation alone over an update of 10 tets, n = " + std::to_string(n),
            .figure = bench::milliseconds(rendered),
            .baseline = bench::milliseconds(seconds),
            .ratio = seconds / rendered,
            .bound = {},
            .error = wrong < 1e-6 ? "" : "Eigen's solve is wrong"});
}

void measure_block(bench::RowFile& rows, int n, double limit, bool with_eigen) {
  const Block b(n);
  const int repeats = n > 20 ? 5 : 9;
  const std::string at = ", n = " + std::to_string(n) + ", " + std::to_string(b.system.base().size()) + " dofs";
  double ten = 0.0;
  for (const int count : {1, 10, 50}) {
    const Cost inside = measure(b, b.burn({0.05, 0.05, 0.06}, count), repeats);
    report(rows, std::to_string(count) + " tets inside" + at, inside, count <= 10 ? limit : 0.0);
    if (count == 10) ten = inside.rendered;
    report(rows, std::to_string(count) + " tets at the surface" + at,
           measure(b, b.burn({0.05, 0.05, 0.1}, count), repeats), count <= 10 ? limit : 0.0);
  }
  report(rows, "slit, 20 x 10 mm" + at, measure(b, b.slit(0.02, 0.01), repeats), 0.0);
  report(rows, "slit, 60 x 30 mm" + at, measure(b, b.slit(0.06, 0.03), repeats), 0.0);
  const Block region(n, 0.1 - 2.5 * 0.1 / n);
  report(rows, "10 tets in a region of " + std::to_string(region.system.kept()) + " kept dofs" + at,
         measure(region, region.burn({0.05, 0.05, 0.1}, 10), repeats), limit);
  report(rows, "slit, 20 x 10 mm, in that region" + at, measure(region, region.slit(0.02, 0.01), repeats), 0.0);
  if (with_eigen) eigen_refactor(rows, b, n, ten);
}

}  // namespace

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  measure_organ(rows, bench::option(argc, argv, "--trace", ""));
  measure_moving_organ(rows);
  if (bench::has_option(argc, argv, "--organ")) return rows.failed() ? 1 : 0;
  measure_block(rows, 10, 0.016, true);
  measure_block(rows, 16, 0.016, true);
  measure_block(rows, 24, 0.05, bench::has_option(argc, argv, "--long"));
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_cut: %s\n", e.what());
  return 1;
}
