// A deformable body of tetrahedra in Bullet, as a baseline. Only where Bullet is installed.
#pragma once

#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace bench {

/// Implicit Euler without damping, collisions and sleep. Masses [kg] per node, gravity [m/s^2].
class BulletBody {
 public:
  BulletBody(const palpate::Mesh<palpate::Tet4>& mesh, const palpate::VectorX& mass,
             std::span<const palpate::NodeId> constrained, std::unique_ptr<btDeformableLagrangianForce> elasticity,
             double gravity)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_, &deformable_),
        elasticity_(std::move(elasticity)) {
    solver_.setDeformableSolver(&deformable_);
    const btVector3 acceleration(0, 0, btScalar(-gravity));
    world_.setGravity(acceleration);
    world_.getWorldInfo().m_gravity = acceleration;
    world_.setImplicit(true);
    world_.setLineSearch(false);
    world_.setUseProjection(true);  // with its other method of fixing nodes, the body in version 3.24 does not move
    std::vector<btVector3> x;
    for (const palpate::Vector3& p : mesh.positions) x.emplace_back(btScalar(p.x()), btScalar(p.y()), btScalar(p.z()));
    std::vector<btScalar> nodal;
    for (const double m : mass) nodal.push_back(static_cast<btScalar>(m));
    body_ = new btSoftBody(&world_.getWorldInfo(), static_cast<int>(x.size()), x.data(), nodal.data());
    for (const auto& e : mesh.elements) body_->appendTetra(e[0], e[1], e[2], e[3]);
    for (const palpate::NodeId node : constrained) body_->setMass(node, 0);
    body_->initializeDmInverse();
    body_->m_tetraScratches.resize(body_->m_tetras.size());
    body_->m_tetraScratchesTn.resize(body_->m_tetras.size());
    body_->m_cfg.collisions = 0;
    body_->setSelfCollision(false);
    body_->m_sleepingThreshold = 0;
    world_.addSoftBody(body_);
    world_.addForce(body_, elasticity_.get());
    if (gravity == 0.0) return;
    weight_ = std::make_unique<btDeformableGravityForce>(acceleration);
    world_.addForce(body_, weight_.get());
  }
  ~BulletBody() {
    world_.removeSoftBody(body_);
    delete body_;
  }
  BulletBody(const BulletBody&) = delete;
  BulletBody& operator=(const BulletBody&) = delete;

  void step(double h) { world_.stepSimulation(btScalar(h), 1, btScalar(h)); }
  palpate::Vector3 position(palpate::NodeId node) const {
    const btVector3& x = body_->m_nodes[node].m_x;
    return {static_cast<double>(x.x()), static_cast<double>(x.y()), static_cast<double>(x.z())};
  }
  /// Moves a constrained node.
  void place(palpate::NodeId node, const palpate::Vector3& at) {
    btSoftBody::Node& n = body_->m_nodes[node];
    n.m_x = n.m_q = btVector3(btScalar(at.x()), btScalar(at.y()), btScalar(at.z()));
  }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver solver_;
  btDeformableMultiBodyDynamicsWorld world_;
  std::unique_ptr<btDeformableLagrangianForce> elasticity_;
  std::unique_ptr<btDeformableGravityForce> weight_;
  btSoftBody* body_ = nullptr;
};

}  // namespace bench
