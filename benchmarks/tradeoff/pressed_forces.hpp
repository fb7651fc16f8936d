// Spheres pressed into a body, as a stiff potential, for references without a time limit.
#pragma once

#include <palpate/model/moving/equilibrium.hpp>

#include <memory>

namespace tradeoff {

using namespace palpate;

/// The forces of a body and of spheres that push its nodes out: energy k/2 depth^2 for every node inside a sphere.
class PressedForces : public ElasticForces {
 public:
  /// `nodes` can be pressed; `stiffness` is the contact stiffness of a node [N/m].
  PressedForces(std::unique_ptr<ElasticForces> body, std::vector<NodeId> nodes, std::vector<Vector3> positions,
                double radius, double stiffness)
      : body_(std::move(body)),
        nodes_(std::move(nodes)),
        positions_(std::move(positions)),
        radius_(radius),
        stiffness_(stiffness) {}

  void place(std::vector<Vector3> centres) { centres_ = std::move(centres); }
  /// Scales the contact stiffness by `share` until the next call.
  void soften(double share) noexcept { share_ = share; }
  /// Force of the body on every sphere [N].
  std::vector<Vector3> forces_on_spheres(const VectorX& u) const {
    std::vector<Vector3> forces(centres_.size(), Vector3::Zero());
    for_each_pressed(u, [&](std::size_t sphere, NodeId, double depth, const Vector3& out) {
      forces[sphere] -= stiffness() * depth * out;
    });
    return forces;
  }
  /// Largest depth of a node in a sphere [m].
  double largest_depth(const VectorX& u) const {
    double largest = 0.0;
    for_each_pressed(u, [&](std::size_t, NodeId, double depth, const Vector3&) { largest = std::max(largest, depth); });
    return largest;
  }
  const ElasticForces& body() const noexcept { return *body_; }

  Index size() const noexcept override { return body_->size(); }
  double energy(const VectorX& u) const noexcept override {
    double sum = body_->energy(u);
    for_each_pressed(
        u, [&](std::size_t, NodeId, double depth, const Vector3&) { sum += 0.5 * stiffness() * depth * depth; });
    return sum;
  }
  DeformationReport force(const VectorX& u, VectorX& f) const noexcept override {
    const DeformationReport report = body_->force(u, f);
    for_each_pressed(u, [&](std::size_t, NodeId node, double depth, const Vector3& out) {
      f.segment<3>(3 * Index{node}) -= stiffness() * depth * out;
    });
    return report;
  }
  /// Without the term of the rotating normal, which is not positive definite, and small for small depths.
  void tangent(const VectorX& u, BlockMatrix& k) const noexcept override {
    body_->tangent(u, k);
    for_each_pressed(u, [&](std::size_t, NodeId node, double, const Vector3& out) {
      k.block(k.pattern().diagonal(node)) += stiffness() * out * out.transpose();
    });
  }

 private:
  double stiffness() const noexcept { return share_ * stiffness_; }
  template <class Visit>
  void for_each_pressed(const VectorX& u, Visit visit) const {
    for (const NodeId node : nodes_)
      for (std::size_t b = 0; b < centres_.size(); ++b) {
        const Vector3 off = positions_[static_cast<std::size_t>(node)] + u.segment<3>(3 * Index{node}) - centres_[b];
        const double distance = off.norm();
        if (distance < radius_ && distance > 0.0) visit(b, node, radius_ - distance, Vector3(off / distance));
      }
  }

  std::unique_ptr<ElasticForces> body_;
  std::vector<NodeId> nodes_;
  std::vector<Vector3> positions_, centres_;
  double radius_, stiffness_, share_ = 1.0;
};

/// A body in equilibrium with spheres pressed into it.
class PressedEquilibrium {
 public:
  PressedEquilibrium(DeformableBody body, std::vector<NodeId> nodes, double radius, double stiffness)
      : body_(press(std::move(body), std::move(nodes), radius, stiffness, pressed_)) {}

  /// Finds the equilibrium for new centres, starting from the present state. Throws not_converged.
  void move_to(std::vector<Vector3> centres) {
    pressed_->place(std::move(centres));
    EquilibriumReport report;
    for (const double share : {0.05, 1.0}) {  // soft contact first determines the pressed nodes
      pressed_->soften(share < 1.0 ? share : stiffer_);
      report = body_.step(
          0.0, {.newton = {.maximum_iterations = 60, .tolerance = share < 1.0 ? 1e-3 : 1e-6}, .smallest_step = 0.5});
      iterations += report.iterations;
    }
    if (!report.converged || report.deformation.inverted > 0) raise(SetupErrorKind::not_converged, describe(report));
  }
  /// Doubles the contact stiffness from now on.
  void stiffen() noexcept { stiffer_ *= 2.0; }
  const VectorX& displacement() const noexcept { return body_.displacement(); }
  std::vector<Vector3> forces_on_spheres() const { return pressed_->forces_on_spheres(body_.displacement()); }
  double largest_depth() const { return pressed_->largest_depth(body_.displacement()); }
  /// Total force of the supports [N]; balances the forces of the spheres.
  Vector3 support() const {
    VectorX f(displacement().size());
    pressed_->body().force(displacement(), f);
    Vector3 sum = Vector3::Zero();
    for (Index dof = 0; dof < f.size(); ++dof)
      if (body_.conditions().is_constrained(dof)) sum[dof % 3] += f[dof];
    return sum;
  }

  int iterations = 0;

 private:
  static DeformableBody press(DeformableBody body, std::vector<NodeId> nodes, double radius, double stiffness,
                              PressedForces*& pressed) {
    auto forces =
        std::make_unique<PressedForces>(std::move(body.elastic), std::move(nodes), body.positions, radius, stiffness);
    pressed = forces.get();
    body.elastic = std::move(forces);
    return body;
  }

  PressedForces* pressed_ = nullptr;
  double stiffer_ = 1.0;
  Equilibrium body_;
};

}  // namespace tradeoff
