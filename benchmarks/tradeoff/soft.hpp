// Moving tissue felt through a servo.
#pragma once

#include <palpate/model/moving/implicit.hpp>

#include "free_motion.hpp"
#include "linear.hpp"

namespace tradeoff {

template <class Law>
RegionMaterials<Law> large_strain_laws(const RegionMaterials<LinearElastic>& materials) {
  RegionMaterials<Law> laws;
  for (const auto& [region, m] : materials)
    if constexpr (requires(Law material) { material.base; })
      laws.push_back({region, Law{m}});
    else
      laws.push_back({region, Law{m.youngs_modulus, m.poisson_ratio, m.density}});
  return laws;
}

/// A model that moves. `Law` is the material, `E` the element.
template <class E, class Law, class Solver>
class SoftContender : public Contender {
 public:
  using Tissue = HapticFEModel<E, Law, Solver>;
  using Parameters = typename Tissue::Parameters;

  SoftContender(const Bench& bench, const std::string& mesh, const Parameters& parameters)
      : bench_(bench),
        parameters_(parameters),
        mesh_(mesh_for<E>(bench.mesh(mesh))),
        laws_(large_strain_laws<Law>(bench.scene.materials)),
        tissue_(mesh_, bench.scene.scene(near_group), laws_, {}, parameters),
        felt_(tissue_, bench.scene) {}

  std::span<const Vector3> tick(std::span<const Vector3> centres) override { return felt_.tick(centres); }
  double update_period() const override { return parameters_.step; }
  void update() override { tissue_.advance(); }
  bool has_inertia() const override { return true; }
  VectorX displacement() override { return tissue_.motion().displacement().head(3 * bench_.scene.mesh.node_count()); }
  /// How far the supports, by the exact law, are from holding what the spheres push, of the contact force.
  double own_error() override {
    const DeformableBody& body = exact();
    VectorX left(body.elastic->size()), contact = VectorX::Zero(left.size());
    body.elastic->force(tissue_.motion().displacement(), left);
    for (const VertexForce& f : felt_.vertex_forces())
      contact.segment<3>(3 * Index{tissue_.touchable_nodes()[static_cast<std::size_t>(f.vertex)]}) +=
          f.force.in_model_axes();
    Vector3 sum = Vector3::Zero();  // the supports against the spheres
    for (Index dof = 0; dof < left.size(); ++dof)
      if (body.conditions.is_constrained(dof)) sum[dof % 3] += left[dof];
    for (Index i = 0; i < contact.size() / 3; ++i) sum += contact.segment<3>(3 * i);
    return sum.norm() / contact.norm();
  }
  double energy_drift() override {
    Parameters free = parameters_;
    free.mass_damping = 0.0;
    free.settle = false;
    const auto motion = SolverTraits<Solver>::make_motion(make_hyperelastic_body(mesh_, laws_),
                                                          bench_.scene.scene(near_group), free, SetupLimits{})
                            .motion;
    const VectorX start = tissue_.motion().displacement();
    motion->rest_at(start);
    const double before = exact().elastic->energy(start);
    for (double t = 0.0; t < free_swing - 1e-9; t += free.step) motion->step(free.step);
    const VectorX mass = lumped_mass(tissue_.body());
    double kinetic = 0.0;
    for (Index i = 0; i < mass.size(); ++i)
      kinetic += 0.5 * mass[i] * motion->velocity().template segment<3>(3 * i).squaredNorm();
    return (kinetic + exact().elastic->energy(motion->displacement())) / before - 1.0;
  }
  Index nodes() const override { return mesh_.node_count(); }
  Index kept_dofs() const override { return 3 * static_cast<Index>(tissue_.touchable_nodes().size()); }
  std::string remark() override { return felt_.remark(); }

 private:
  const DeformableBody& exact() {
    if (!exact_.elastic)
      exact_ = make_constrained_body(make_hyperelastic_body(mesh_, laws_), bench_.scene.scene(near_group));
    return exact_;
  }
  const Bench& bench_;
  Parameters parameters_;
  Mesh<E> mesh_;
  RegionMaterials<Law> laws_;
  Tissue tissue_;
  Felt<Tissue> felt_;
  DeformableBody exact_;
};

/// An entry of a moving model; `paste` is C++ for it.
template <class E, class Law, class Solver>
Entry soft_entry(const Bench& bench, const std::string& element, const std::string& material, const std::string& solver,
                 const std::string& mesh, const std::string& scalar, const std::string& work,
                 const typename HapticFEModel<E, Law, Solver>::Parameters& parameters, const std::string& paste) {
  Entry entry{{.family = "moving",
               .element = element,
               .mesh = mesh_name(mesh),
               .kinematics = material,
               .solver = solver,
               .kept = kept_name(near_group),
               .scalar = scalar,
               .work = work,
               .paste = paste,
               .allowed = 0.05,
               .own_core = true}};
  entry.make = [&bench, mesh, parameters] {
    return std::make_unique<SoftContender<E, Law, Solver>>(bench, mesh, parameters);
  };
  return entry;
}

}  // namespace tradeoff
