// Nodes that move as particles and are pushed out of the spheres; the contact force follows from that displacement.
#pragma once

#include <palpate/assembly/mass_matrix.hpp>

#include <algorithm>

#include "contender.hpp"
#include "free_motion.hpp"

namespace tradeoff {

/// Nodes with mass that are constrained, or kept outside the spheres.
struct Particles {
  std::vector<Vector3> rest, place, before, velocity, force;
  std::vector<double> inverse_mass;
  std::vector<NodeId> touchable;
  double radius = 0.0;

  Particles(const Bench& bench, const Mesh<Tet4>& mesh)
      : rest(mesh.positions),
        place(rest),
        before(rest),
        velocity(rest.size(), Vector3::Zero()),
        force(velocity),
        touchable(mesh.find_group(near_group)->nodes),
        radius(bench.scene.radius) {
    const VectorX mass = lumped_mass(make_body(mesh, bench.scene.materials));
    for (const double m : mass) inverse_mass.push_back(1.0 / m);
    for (const NodeId node : mesh.find_group(constrained_group)->nodes)
      inverse_mass[static_cast<std::size_t>(node)] = 0.0;
  }
  /// Moves nodes out of the spheres; adds the force of that displacement in a step of dt to the forces on the spheres.
  void push_out(std::span<const Vector3> centres, double dt, std::vector<Vector3>& forces) {
    for (const NodeId node : touchable)
      for (std::size_t b = 0; b < centres.size(); ++b) {
        const auto i = static_cast<std::size_t>(node);
        const Vector3 off = place[i] - centres[b];
        const double depth = radius - off.norm();
        if (!(depth > 0.0) || inverse_mass[i] == 0.0) continue;
        const Vector3 path = depth * off.normalized();
        place[i] += path;
        forces[b] -= path / (inverse_mass[i] * dt * dt);
      }
  }
  void predict(double dt) {
    const double kept = std::max(0.0, 1.0 - damping_ * dt);
    for (std::size_t i = 0; i < place.size(); ++i) {
      before[i] = place[i];
      if (inverse_mass[i] == 0.0) continue;
      velocity[i] = kept * velocity[i] + dt * inverse_mass[i] * force[i];
      place[i] += dt * velocity[i];
    }
  }
  void find_velocity(double dt) {
    for (std::size_t i = 0; i < place.size(); ++i) velocity[i] = (place[i] - before[i]) / dt;
  }
  double kinetic_energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i)
      if (inverse_mass[i] > 0.0) sum += 0.5 / inverse_mass[i] * velocity[i].squaredNorm();
    return sum;
  }
  VectorX displacement() const {
    VectorX u(3 * static_cast<Index>(place.size()));
    for (std::size_t i = 0; i < place.size(); ++i) u.segment<3>(3 * static_cast<Index>(i)) = place[i] - rest[i];
    return u;
  }
  double damping_ = rest_damping;
};

/// Contender for a `Body` with the members particles, step(dt, centres, forces), energy() and support_reaction().
template <class Body>
class ParticleContender : public Contender {
 public:
  ParticleContender(const Bench& bench, Body body, int steps)
      : bench_(bench), body_(std::move(body)), steps_(steps), forces_(bench.scene.spheres.size()), now_(forces_) {}

  /// The spheres move uniformly during a tick: a jump in its first step would be an impact, stronger for shorter steps.
  std::span<const Vector3> tick(std::span<const Vector3> centres) override {
    if (before_.empty()) before_.assign(centres.begin(), centres.end());
    std::ranges::fill(forces_, Vector3::Zero());
    for (int s = 1; s <= steps_; ++s) {
      for (std::size_t b = 0; b < now_.size(); ++b)
        now_[b] = before_[b] + static_cast<double>(s) / steps_ * (centres[b] - before_[b]);
      body_.step(1e-3 / steps_, now_, forces_);
    }
    before_.assign(centres.begin(), centres.end());
    for (Vector3& f : forces_) f /= steps_;
    return forces_;
  }
  bool has_inertia() const override { return true; }
  VectorX displacement() override { return body_.particles.displacement().head(3 * bench_.scene.mesh.node_count()); }
  /// Relative difference between the forces on constrained nodes and on the spheres.
  double own_error() override {
    Vector3 sum = body_.support_reaction();
    double size = 0.0;
    for (const Vector3& f : forces_) {
      sum -= f;
      size += f.norm();
    }
    return sum.norm() / size;
  }
  double energy_drift() override {
    Body free = body_;
    free.particles.damping_ = 0.0;
    std::ranges::fill(free.particles.velocity, Vector3::Zero());
    const double before = free.energy();
    std::vector<Vector3> none;
    for (double t = 0.0; t < free_swing - 1e-9; t += 1e-3 / steps_) free.step(1e-3 / steps_, {}, none);
    return (free.energy() + free.particles.kinetic_energy()) / before - 1.0;
  }
  Index nodes() const override { return static_cast<Index>(body_.particles.rest.size()); }
  std::string remark() override { return std::to_string(steps_) + " steps per tick"; }

 private:
  const Bench& bench_;
  Body body_;
  int steps_;
  // Forces on the spheres; their centres in the present step and in the previous tick.
  std::vector<Vector3> forces_, now_, before_;
};

}  // namespace tradeoff
