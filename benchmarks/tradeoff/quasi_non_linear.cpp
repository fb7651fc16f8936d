// Cotin's quasi-non-linear elasticity over a linear composition.
#include <palpate/model/static/stiffening.hpp>

#include "linear.hpp"

namespace tradeoff {
namespace {

using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

StiffeningCurve curve(const Stiffening& measured) {
  std::vector<StiffeningCurve::Point> points{{0.0, 1.0}};
  for (std::size_t i = 0; i < measured.depth.size(); ++i) points.push_back({measured.depth[i], measured.ratio[i]});
  return StiffeningCurve(points);
}

/// The curves were measured at another point of the same organ; displacements are scaled like the force.
class CotinContender : public LinearContender<Smoothed<Tet4>, Condensed<SelectiveInverse>, QuasiNonLinear<Model>> {
 public:
  CotinContender(const Bench& bench, const std::string& mesh)
      : LinearContender(bench, mesh, near_group, {}, [&](Model& model) {
          return QuasiNonLinear<Model>(model, curve(bench.stiffening), curve(bench.stiffening));
        }) {}

  VectorX displacement() override {
    // T u(T f), T: see scale()
    std::vector<VertexForce> forces(rendered_.vertex_forces().begin(), rendered_.vertex_forces().end());
    for (VertexForce& f : forces) f.force = ModelVector(tissue_.scale() * f.force.in_model_axes());
    model_.displacement_with(forces, u_);
    for (Index i = 0; i < u_.size() / 3; ++i) u_.segment<3>(3 * i) = (tissue_.scale() * u_.segment<3>(3 * i)).eval();
    return of_given_nodes(u_, model_.node_map(), bench_.scene.mesh.node_count());
  }
};

}  // namespace

void add_quasi_non_linear(const Bench& bench, std::vector<Entry>& entries) {
  if (bench.stiffening.depth.empty()) return;  // the curve is measured for one sphere
  for (const std::string mesh : {"given", "near"}) {
    Entry entry;
    Description& d = entry.description;
    d.family = "condensed";
    d.element = "Smoothed<Tet4>";
    d.mesh = mesh_name(mesh);
    d.kinematics = "quasi-non-linear (Cotin)";
    d.solver = "Condensed<SelectiveInverse>";
    d.kept = kept_name(near_group);
    d.scalar = "double";
    d.allowed = 2e-2;
    d.paste =
        "using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>;   // "
        "with "
        "{.axial = ...}, a StiffeningCurve measured on the tissue";
    entry.make = [&bench, mesh] { return std::make_unique<CotinContender>(bench, mesh); };
    entries.push_back(std::move(entry));
  }
}

}  // namespace tradeoff
