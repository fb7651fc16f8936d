// Neo-Hookean tissue in explicit steps; the spheres act by penalty forces, as there is no servo for explicit motion.
#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/element_frequency.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>
#include <palpate/material/neo_hookean.hpp>

#include "soft.hpp"

namespace tradeoff {
namespace {

template <class Forces, class Scheme>
class ExplicitContender : public Contender {
 public:
  ExplicitContender(const Bench& bench, const std::string& mesh)
      : bench_(bench),
        body_(make_hyperelastic_body(bench.mesh(mesh), large_strain_materials<NeoHookean>(bench.scene.materials))),
        conditions_(
            resolve_essential(body_.rest.mesh, extract_boundary<Tet4>(body_.rest.mesh), bench.scene.scene(near_group))),
        mass_(lumped_mass(body_.rest)),
        motion_(make(rest_damping)),
        nodes_(body_.rest.mesh.find_group(near_group)->nodes),
        forces_(bench.scene.spheres.size()),
        now_(forces_) {
    // Equal steps per millisecond of at most 0.7 of the limit: compressed elements have a smaller limit than elements
    // at rest.
    steps_ = static_cast<int>(std::ceil(1e-3 / (0.7 * motion_.limit())));
  }

  /// The spheres move uniformly during a tick: a jump in its first step would be an impact.
  std::span<const Vector3> tick(std::span<const Vector3> centres) override {
    if (before_.empty()) before_.assign(centres.begin(), centres.end());
    std::ranges::fill(forces_, Vector3::Zero());
    const double dt = 1e-3 / steps_;
    for (int s = 1; s <= steps_; ++s) {
      for (std::size_t b = 0; b < now_.size(); ++b)
        now_[b] = before_[b] + static_cast<double>(s) / steps_ * (centres[b] - before_[b]);
      push(now_, dt);
      status_ |= motion_.step(dt);
    }
    before_.assign(centres.begin(), centres.end());
    for (Vector3& f : forces_) f /= steps_;
    return forces_;
  }
  bool has_inertia() const override { return true; }
  VectorX displacement() override { return motion_.state().displacement.head(3 * bench_.scene.mesh.node_count()); }
  double own_error() override {
    Vector3 sum = Vector3::Zero(), contact = Vector3::Zero();
    for (Index dof = 0; dof < motion_.state().force.size(); ++dof)
      if (conditions_.is_constrained(dof)) sum[dof % 3] += motion_.state().force[dof];
    double size = 0.0;
    for (const Vector3& f : forces_) {
      contact -= f;
      size += f.norm();
    }
    return (sum + contact).norm() / size;
  }
  double energy_drift() override {
    auto free = make(0.0);
    free.set(motion_.state().displacement, VectorX::Zero(motion_.state().displacement.size()));
    const double before = free.stored_energy(), dt = 1e-3 / steps_;
    Status status;
    for (double t = 0.0; t < free_swing - 1e-9; t += dt) status |= free.step(dt);
    return status.has(StatusFlag::step_refused) || status.has(StatusFlag::energy_grew)
               ? std::numeric_limits<double>::quiet_NaN()
               : (free.kinetic_energy() + free.stored_energy()) / before - 1.0;
  }
  Index nodes() const override { return body_.rest.mesh.node_count(); }
  std::string remark() override {
    std::string text = std::to_string(steps_) + " steps per tick";
    for (const StatusFlag flag : {StatusFlag::energy_grew, StatusFlag::step_refused, StatusFlag::inverted})
      if (status_.has(flag)) text += flag == StatusFlag::inverted ? ", inverted" : ", STOPPED by the energy check";
    return text;
  }

 private:
  auto make(double damping) const {
    ExplicitOptions options;
    options.damping = damping;
    return ExplicitMotion<Forces, Scheme>(Forces(body_), mass_, conditions_.free_dofs,
                                          element_frequency_bound(body_.rest), options);
  }
  /// Pushes every node out of the spheres by a penalty with half of the largest stable stiffness of a step. Uses the
  /// predicted position after the step, as the load of a step acts at its end. Delayed forces would add energy.
  void push(std::span<const Vector3> centres, double dt) {
    motion_.load().setZero();
    for (const NodeId node : nodes_)
      for (std::size_t b = 0; b < centres.size(); ++b) {
        const Index dof = 3 * Index{node};
        const Vector3 off = body_.rest.mesh.position(node) + motion_.state().displacement.template segment<3>(dof) +
                            dt * motion_.state().velocity.template segment<3>(dof) - centres[b];
        const double depth = bench_.scene.radius - off.norm();
        if (!(depth > 0.0)) continue;
        const Vector3 force = 0.5 * mass_[node] / (dt * dt) * depth * off.normalized();
        motion_.load().template segment<3>(dof) += force;
        forces_[b] -= force;
      }
  }

  const Bench& bench_;
  HyperelasticBody<Tet4, NeoHookean> body_;
  EssentialConditions conditions_;
  VectorX mass_;
  ExplicitMotion<Forces, Scheme> motion_;
  std::vector<NodeId> nodes_;
  // Forces on the spheres; their centres in the present step and in the previous tick.
  std::vector<Vector3> forces_, now_, before_;
  int steps_ = 1;
  Status status_;
};

template <class Forces, class Scheme>
void add(const Bench& bench, std::vector<Entry>& entries, const std::string& mesh, const std::string& element,
         const std::string& forces, const std::string& scheme, const std::string& scalar) {
  Entry entry;
  Description& d = entry.description;
  d.family = "explicit";
  d.element = element;
  d.mesh = mesh_name(mesh);
  d.kinematics = "neo-Hookean";
  d.solver = scheme;
  d.scalar = scalar;
  d.allowed = 0.05;
  d.paste = "using Motion = ExplicitMotion<" + forces + ", " + scheme + ">;   // spheres by penalty loads";
  entry.make = [&bench, mesh] { return std::make_unique<ExplicitContender<Forces, Scheme>>(bench, mesh); };
  entries.push_back(std::move(entry));
}

}  // namespace

void add_explicit(const Bench& bench, std::vector<Entry>& entries) {
  add<BatchedTetrahedra<NeoHookean>, CentralDifference>(bench, entries, "given", "Tet4",
                                                        "BatchedTetrahedra<NeoHookean>", "CentralDifference", "double");
  for (const std::string& mesh : meshes_for_node_contact(bench))
    add<BatchedTetrahedra<NeoHookean, float>, CentralDifference>(
        bench, entries, mesh, "Tet4", "BatchedTetrahedra<NeoHookean, float>", "CentralDifference", "float");
}

}  // namespace tradeoff
