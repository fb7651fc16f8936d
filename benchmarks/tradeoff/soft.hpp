// Moving tissue felt through a servo.
#pragma once

#include <palpate/model/corotated_tissue.hpp>

#include "free_motion.hpp"
#include "linear.hpp"

namespace tradeoff {

template <class Law>
RegionMaterials<Law> large_strain_laws(const RegionMaterials<LinearElastic>& materials) {
  RegionMaterials<Law> laws;
  for (const auto& [region, m] : materials)
    if constexpr (requires(Law law) { law.base; })
      laws.push_back({region, Law{m}});
    else
      laws.push_back({region, Law{m.youngs_modulus, m.poisson_ratio, m.density}});
  return laws;
}

/// SoftTissue or CorotatedTissue. `Law` is the material, `E` the element.
template <class Tissue, class E, class Law>
class SoftContender : public Contender {
 public:
  using Options = typename Tissue::Options;

  SoftContender(const Bench& bench, const std::string& mesh, const Options& options)
      : bench_(bench),
        options_(options),
        mesh_(mesh_for<E>(bench.mesh(mesh))),
        laws_(large_strain_laws<Law>(bench.scene.materials)),
        tissue_(mesh_, bench.scene.scene(near_group), laws_, options),
        felt_(tissue_, bench.scene) {}

  std::span<const Vector3> tick(std::span<const Vector3> centres) override { return felt_.tick(centres); }
  double update_period() const override { return options_.step; }
  void update() override { tissue_.advance(); }
  bool has_inertia() const override { return true; }
  VectorX displacement() override { return tissue_.motion().displacement().head(3 * bench_.scene.mesh.node_count()); }
  /// How far the supports, by the exact law, are from holding what the balls push, of the contact force.
  double own_error() override {
    const DeformableBody& body = exact();
    VectorX left(body.elastic->size()), contact = VectorX::Zero(left.size());
    body.elastic->force(tissue_.motion().displacement(), left);
    for (const VertexForce& f : felt_.vertex_forces())
      contact.segment<3>(3 * Index{tissue_.touchable_nodes()[static_cast<std::size_t>(f.vertex)]}) += f.force;
    Vector3 sum = Vector3::Zero();  // the supports against the balls
    for (Index dof = 0; dof < left.size(); ++dof)
      if (body.conditions.is_constrained(dof)) sum[dof % 3] += left[dof];
    for (Index i = 0; i < contact.size() / 3; ++i) sum += contact.segment<3>(3 * i);
    return sum.norm() / contact.norm();
  }
  double energy_drift() override {
    auto source = tissue_source();
    Options free = options_;
    free.motion.mass_damping = 0.0;
    return swing(source, free.motion);
  }
  Index nodes() const override { return mesh_.node_count(); }
  Index kept_dofs() const override { return 3 * static_cast<Index>(tissue_.touchable_nodes().size()); }
  std::string remark() override { return felt_.remark(); }

 private:
  using Motion = std::remove_cvref_t<decltype(std::declval<Tissue>().motion())>;

  const DeformableBody& exact() {
    if (!exact_.elastic) exact_ = make_held_body(make_hyperelastic_body(mesh_, laws_), bench_.scene.scene(near_group));
    return exact_;
  }
  auto tissue_source() {
    return TissueMotion<Motion>::source(make_hyperelastic_body(mesh_, laws_), bench_.scene.scene(near_group),
                                        SetupLimits{});
  }
  template <class Source, class Parameters>
  double swing(Source& source, const Parameters& parameters) {
    Motion motion(std::move(source), parameters, SetupLimits{});
    const VectorX start = tissue_.motion().displacement();
    motion.set_state(start, VectorX::Zero(start.size()));
    const double before = exact().elastic->energy(start);
    for (double t = 0.0; t < free_swing - 1e-9; t += options_.step) motion.step(options_.step);
    double kinetic = 0.0;
    for (Index i = 0; i < motion.body().lumped.size(); ++i)
      kinetic += 0.5 * motion.body().lumped[i] * motion.velocity().template segment<3>(3 * i).squaredNorm();
    return (kinetic + exact().elastic->energy(motion.displacement())) / before - 1.0;
  }

  const Bench& bench_;
  Options options_;
  Mesh<E> mesh_;
  RegionMaterials<Law> laws_;
  Tissue tissue_;
  Felt<Tissue> felt_;
  DeformableBody exact_;
};

/// An entry of a moving tissue; `text` is C++ for its options.
template <class Tissue, class E, class Law>
Entry soft_entry(const Bench& bench, const std::string& element, const std::string& law, const std::string& solver,
                 const std::string& mesh, const std::string& scalar, const std::string& work,
                 const typename Tissue::Options& options, const std::string& paste) {
  Entry entry{{.family = "moving",
               .element = element,
               .mesh = mesh_name(mesh),
               .kinematics = law,
               .solver = solver,
               .kept = kept_name(near_group),
               .scalar = scalar,
               .work = work,
               .paste = paste,
               .allowed = 0.05,
               .own_core = true}};
  entry.make = [&bench, mesh, options] {
    return std::make_unique<SoftContender<Tissue, E, Law>>(bench, mesh, options);
  };
  return entry;
}

}  // namespace tradeoff
