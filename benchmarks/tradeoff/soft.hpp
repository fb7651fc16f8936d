// Moving tissue rendered by a servo.
#pragma once

#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "free_motion.hpp"
#include "linear.hpp"

namespace tradeoff {

template <class Material>
RegionMaterials<Material> large_strain_materials(const RegionMaterials<LinearElastic>& materials) {
  RegionMaterials<Material> converted;
  for (const auto& [region, m] : materials)
    converted.push_back({region, Material{m.youngs_modulus, m.poisson_ratio, m.density}});
  return converted;
}

/// The mesh converted for element E, as a mesh of E.
template <Element E>
Mesh<E> mesh_of(const Mesh<Tet4>& mesh) {
  if constexpr (detail::HasSmoothedStrain<E>)
    return copy_mesh<E>(mesh);
  else
    return mesh_for<E>(mesh);
}

/// A moving model. `Material` is the material, `E` the element.
template <class E, class Material, class Solver>
class SoftContender : public Contender {
 public:
  using Tissue = HapticFEModel<E, Material, Solver>;
  using Parameters = typename Tissue::Parameters;

  SoftContender(const Bench& bench, const std::string& mesh, const Parameters& parameters)
      : bench_(bench),
        parameters_(parameters),
        mesh_(mesh_of<E>(bench.mesh(mesh))),
        materials_(large_strain_materials<Material>(bench.scene.materials)),
        tissue_(mesh_, bench.scene.scene(near_group), materials_, {}, parameters),
        conditions_(palpate::detail::body_without_mass(tissue_.body(), bench.scene.scene(near_group)).conditions),
        rendered_(tissue_, bench.scene) {}

  std::span<const Vector3> tick(std::span<const Vector3> centres) override { return rendered_.tick(centres); }
  double update_period() const override { return parameters_.step; }
  void update() override { tissue_.advance(); }
  bool has_inertia() const override {
    if constexpr (requires { parameters_.inertia; })
      return parameters_.inertia;
    else
      return true;
  }
  VectorX displacement() override { return tissue_.displacement().head(3 * bench_.scene.mesh.node_count()); }
  /// Imbalance of support forces, by the exact material, and forces of the spheres, relative to the contact force.
  double own_error() override {
    const VectorX left = support_forces(tissue_.displacement());
    VectorX contact = VectorX::Zero(left.size());
    for (const VertexForce& f : rendered_.vertex_forces())
      contact.segment<3>(3 * Index{tissue_.touchable_nodes()[static_cast<std::size_t>(f.vertex)]}) +=
          f.force.in_model_axes();
    Vector3 sum = Vector3::Zero();  // support forces plus forces of the spheres
    for (Index dof = 0; dof < left.size(); ++dof)
      if (conditions_.is_constrained(dof)) sum[dof % 3] += left[dof];
    for (Index i = 0; i < contact.size() / 3; ++i) sum += contact.segment<3>(3 * i);
    return sum.norm() / contact.norm();
  }
  double energy_drift() override {
    if (!has_inertia()) return std::numeric_limits<double>::quiet_NaN();
    Parameters free = parameters_;
    free.mass_damping = 0.0;
    free.settle = false;
    const auto motion = SolverTraits<Solver>::make_motion(make_hyperelastic_body(mesh_, materials_),
                                                          bench_.scene.scene(near_group), free, SetupLimits{})
                            .motion;
    const VectorX start = tissue_.displacement();
    motion->rest_at(start);
    const double before = energy_at(start);
    for (double t = 0.0; t < free_swing - 1e-9; t += free.step) motion->step(free.step);
    const VectorX mass = lumped_mass(tissue_.body());
    double kinetic = 0.0;
    for (Index i = 0; i < mass.size(); ++i)
      kinetic += 0.5 * mass[i] * motion->velocity().template segment<3>(3 * i).squaredNorm();
    return (kinetic + energy_at(motion->displacement())) / before - 1.0;
  }
  Index nodes() const override { return mesh_.node_count(); }
  Index kept_dofs() const override { return 3 * static_cast<Index>(tissue_.touchable_nodes().size()); }
  std::string remark() override { return rendered_.remark(); }

 private:
  /// Forces in double, of the exact material; linear where the model is.
  VectorX support_forces(const VectorX& u) {
    VectorX f(u.size());
    DeformationReport report;
    if constexpr (requires { parameters_.large_strain_within; })
      if (parameters_.large_strain_within < infinity) {
        const auto body = make_hyperelastic_body(mesh_, materials_);
        const detail::BodyParts parts =
            detail::divide_body(mesh_ref(body.rest.mesh), tissue_.touchable_nodes(), parameters_.large_strain_within);
        const auto far = assemble_stiffness<E>(detail::part_of(body.rest, parts.far_part), SetupLimits{});
        VectorX near_u(3 * static_cast<Index>(parts.near_part.nodes.size())), near_f(near_u.size()), far_u(far.size()),
            far_f(far.size());
        parts.near_part.gather(u, near_u);
        parts.far_part.gather(u, far_u);
        palpate::detail::make_energy_forces<double>(detail::part_of(body, parts.near_part), SetupLimits{})
            ->evaluate(near_u, near_f, report);
        far.apply(far_u, far_f);
        f.setZero();
        parts.far_part.scatter(far_f, f);
        for (std::size_t i = 0; i < parts.near_part.nodes.size(); ++i)
          add_node_vector(f, Index{parts.near_part.nodes[i]}, node_vector(near_f, static_cast<Index>(i)));
        return f;
      }
    exact().evaluate(u, f, report);
    return f;
  }
  detail::EnergyForces& exact() {
    if (!exact_)
      exact_ = palpate::detail::make_energy_forces<double>(make_hyperelastic_body(mesh_, materials_), SetupLimits{});
    return *exact_;
  }
  double energy_at(const VectorX& u) {
    VectorX f(u.size());
    DeformationReport report;
    return exact().evaluate(u, f, report);
  }
  const Bench& bench_;
  Parameters parameters_;
  Mesh<E> mesh_;
  RegionMaterials<Material> materials_;
  Tissue tissue_;
  EssentialConditions conditions_;
  RenderedTissue<Tissue> rendered_;
  std::unique_ptr<detail::EnergyForces> exact_;
};

/// An entry of a moving model; `paste` is its C++ code.
template <class E, class Material, class Solver>
Entry soft_entry(const Bench& bench, const std::string& element, const std::string& material, const std::string& solver,
                 const std::string& mesh, const std::string& scalar, const std::string& work,
                 const typename HapticFEModel<E, Material, Solver>::Parameters& parameters, const std::string& paste) {
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
    return std::make_unique<SoftContender<E, Material, Solver>>(bench, mesh, parameters);
  };
  return entry;
}

}  // namespace tradeoff
