// Rigid instruments in a world of Bullet. No part of palpate is used here.
#pragma once

#include <palpate/core/types.hpp>

#include <btBulletDynamicsCommon.h>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btTransformUtil.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace bullet_example {

using palpate::Vector3;

inline btVector3 to_bullet(const Vector3& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}
inline Vector3 to_eigen(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}
/// w x y z, as ToolState has it.
inline std::array<double, 4> to_array(const btQuaternion& q) {
  return {static_cast<double>(q.w()), static_cast<double>(q.x()), static_cast<double>(q.y()),
          static_cast<double>(q.z())};
}

/// A sphere, or a capsule along the z axis of its own frame.
struct Instrument {
  std::string name;
  double radius = 0.01, half_length = 0.0;  ///< [m]
  double mass = 0.01;                       ///< [kg]
  Vector3 position = Vector3::Zero();       ///< at the start [m]
  btQuaternion rotation = btQuaternion::getIdentity();
  bool upright = false;       ///< it does not rotate
  double hand_stiffness = 0;  ///< [N/m] of the spring by which a hand holds it; 0: it is free
  double hand_damping = 0;    ///< [N s/m]
};

/// A btDiscreteDynamicsWorld with instruments that touch each other. The tissue is no object of this world: its forces
/// come in by `push`.
class RigidWorld {
 public:
  RigidWorld(const std::vector<Instrument>& instruments, const Vector3& gravity)
      : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_), gravity_(gravity) {
    gContactBreakingThreshold = btScalar(5e-4);  // [m] the default, 20 mm, is larger than the instruments
    world_.setGravity(to_bullet(gravity));
    world_.getSolverInfo().m_restitutionVelocityThreshold = btScalar(0.02);  // [m/s]
    for (const Instrument& i : instruments) add(i);
  }
  ~RigidWorld() {
    for (const auto* list : {&bodies_, &walls_})
      for (const auto& body : *list) world_.removeRigidBody(body.get());
  }
  RigidWorld(const RigidWorld&) = delete;
  RigidWorld& operator=(const RigidWorld&) = delete;

  /// A fixed plane, `inward` from which instruments stay.
  void add_wall(const Vector3& point, const Vector3& inward) {
    shapes_.push_back(
        std::make_unique<btStaticPlaneShape>(to_bullet(inward), static_cast<btScalar>(inward.dot(point))));
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(0), nullptr, shapes_.back().get());
    info.m_friction = info.m_restitution = btScalar(0.5);
    walls_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(walls_.back().get());
  }

  std::size_t size() const { return bodies_.size(); }
  const btTransform& pose(std::size_t i) const { return bodies_[i]->getWorldTransform(); }
  Vector3 position(std::size_t i) const { return to_eigen(pose(i).getOrigin()); }
  Vector3 velocity(std::size_t i) const { return to_eigen(bodies_[i]->getLinearVelocity()); }
  Vector3 angular_velocity(std::size_t i) const { return to_eigen(bodies_[i]->getAngularVelocity()); }
  /// The smallest of the three moments of inertia [kg m^2]; infinite for an instrument that does not rotate.
  double inertia(std::size_t i) const {
    const Vector3 inverse = to_eigen(bodies_[i]->getInvInertiaDiagLocal());
    return bodies_[i]->getAngularFactor().isZero() ? palpate::infinity : 1.0 / inverse.maxCoeff();
  }

  /// Adds a force [N] and a torque about the centre of mass [N m] to the step that has just been taken: they change the
  /// velocity by dt times the acceleration, and the pose by dt times that.
  void push(std::size_t i, const Vector3& force, const Vector3& torque, double dt) {
    btRigidBody& body = *bodies_[i];
    const auto h = static_cast<btScalar>(dt);
    const btVector3 velocity = h * body.getInvMass() * to_bullet(force);
    const btVector3 spin = h * (body.getInvInertiaTensorWorld() * (to_bullet(torque) * body.getAngularFactor()));
    btTransform moved;
    btTransformUtil::integrateTransform(body.getWorldTransform(), velocity, spin, h, moved);
    place(body, moved, body.getLinearVelocity() + velocity, body.getAngularVelocity() + spin);
  }
  /// One step of Bullet, with its contacts between instruments.
  void step(double dt) {
    world_.stepSimulation(static_cast<btScalar>(dt), 0);
    for (int k = 0; k < dispatcher_.getNumManifolds(); ++k) {
      const btPersistentManifold* pair = dispatcher_.getManifoldByIndexInternal(k);
      if (pair->getNumContacts() > 0 && !pair->getBody0()->isStaticObject() && !pair->getBody1()->isStaticObject())
        ++collisions_;
    }
  }
  /// Takes an instrument away and lets it fall from another position.
  void drop(std::size_t i, const Vector3& from) {
    const btVector3 zero(0, 0, 0);
    place(*bodies_[i], btTransform(btQuaternion::getIdentity(), to_bullet(from)), zero, zero);
  }

  double kinetic_energy() const {
    double sum = 0.0;
    for (const auto& body : bodies_) {
      const btVector3 w = body->getAngularVelocity() * body->getWorldTransform().getBasis();  // in the body's frame
      sum += 0.5 * static_cast<double>(body->getLinearVelocity().length2() / body->getInvMass());
      for (int a = 0; a < 3; ++a)
        if (!body->getAngularFactor().isZero())
          sum += 0.5 * static_cast<double>(w[a] * w[a] / body->getInvInertiaDiagLocal()[a]);
    }
    return sum;
  }
  double weight_energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < size(); ++i)
      sum -= gravity_.dot(position(i)) / static_cast<double>(bodies_[i]->getInvMass());
    return sum;
  }
  /// Pairs of instruments that touched, summed over the steps.
  long collisions() const { return collisions_; }

 private:
  static void place(btRigidBody& body, const btTransform& pose, const btVector3& velocity, const btVector3& spin) {
    body.setWorldTransform(pose);
    body.setInterpolationWorldTransform(pose);
    body.setLinearVelocity(velocity);
    body.setAngularVelocity(spin);
    body.updateInertiaTensor();
  }
  void add(const Instrument& instrument) {
    const auto radius = static_cast<btScalar>(instrument.radius);
    if (instrument.half_length > 0.0)
      shapes_.push_back(std::make_unique<btCapsuleShapeZ>(radius, static_cast<btScalar>(2.0 * instrument.half_length)));
    else
      shapes_.push_back(std::make_unique<btSphereShape>(radius));
    btVector3 inertia;
    shapes_.back()->calculateLocalInertia(static_cast<btScalar>(instrument.mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(instrument.mass), nullptr, shapes_.back().get(),
                                                  inertia);
    info.m_startWorldTransform = btTransform(instrument.rotation, to_bullet(instrument.position));
    info.m_friction = btScalar(0.3);
    info.m_restitution = btScalar(0.4);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    if (instrument.upright) bodies_.back()->setAngularFactor(btScalar(0));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);  // the tissue below moves
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_, walls_;
  Vector3 gravity_;
  long collisions_ = 0;
};

}  // namespace bullet_example
