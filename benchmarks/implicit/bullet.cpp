// Bullet's deformable bodies on the standard block, as a baseline.
#include "implicit.hpp"

#ifdef PALPATE_BENCH_BULLET
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#endif

namespace implicit_path {

#ifdef PALPATE_BENCH_BULLET
namespace {

constexpr double h = 1e-3, together = 0.2;  // [s]
/// The block under its weight: implicit Euler, co-rotated linear elasticity without damping.
class BulletBlock {
 public:
  explicit BulletBlock(const Pressing& pressing)
      : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_, &deformable_) {
    solver_.setDeformableSolver(&deformable_);
    const btVector3 gravity(0, 0, btScalar(-9.81));
    world_.setGravity(gravity);
    world_.getWorldInfo().m_gravity = gravity;
    world_.setImplicit(true);
    world_.setLineSearch(false);
    world_.setUseProjection(true);  // with its other method of fixing nodes, the body in version 3.24 does not move
    const Mesh<Tet4>& mesh = pressing.body.rest.mesh;
    std::vector<btVector3> x;
    for (const Vector3& p : mesh.positions) x.emplace_back(btScalar(p.x()), btScalar(p.y()), btScalar(p.z()));
    const VectorX lumped = lumped_mass(pressing.body.rest);
    std::vector<btScalar> mass;
    for (const double m : lumped) mass.push_back(static_cast<btScalar>(m));
    body_ = new btSoftBody(&world_.getWorldInfo(), static_cast<int>(x.size()), x.data(), mass.data());
    for (const auto& e : mesh.elements) body_->appendTetra(e[0], e[1], e[2], e[3]);
    for (const NodeId node : pressing.block.constrained) body_->setMass(node, 0);
    body_->initializeDmInverse();
    body_->m_tetraScratches.resize(body_->m_tetras.size());
    body_->m_tetraScratchesTn.resize(body_->m_tetras.size());
    body_->m_cfg.collisions = 0;
    body_->setSelfCollision(false);
    body_->m_sleepingThreshold = 0;
    world_.addSoftBody(body_);
    const auto mu = static_cast<btScalar>(bench::tissue.shear_modulus()),
               lambda = static_cast<btScalar>(bench::tissue.lame_lambda());
    elasticity_ = std::make_unique<btDeformableLinearElasticityForce>(mu, lambda, btScalar(0), btScalar(0));
    weight_ = std::make_unique<btDeformableGravityForce>(gravity);
    world_.addForce(body_, elasticity_.get());
    world_.addForce(body_, weight_.get());
  }
  ~BulletBlock() {
    world_.removeSoftBody(body_);
    delete body_;
  }
  BulletBlock(const BulletBlock&) = delete;
  BulletBlock& operator=(const BulletBlock&) = delete;

  void step() { world_.stepSimulation(btScalar(h), 1, btScalar(h)); }
  double height(NodeId node) const { return static_cast<double>(body_->m_nodes[node].m_x.z()); }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver solver_;
  btDeformableMultiBodyDynamicsWorld world_;
  std::unique_ptr<btDeformableLinearElasticityForce> elasticity_;
  std::unique_ptr<btDeformableGravityForce> weight_;
  btSoftBody* body_ = nullptr;
};

}  // namespace

void measure_bullet(bench::RowFile& rows, int n) {
  const Pressing pressing(n);
  Scene scene;
  scene.fix(pressing.block.constrained).gravity(Vector3(0.0, 0.0, -9.81));
  CorotatedMotionOptions options;
  options.solve.tolerance = 3e-3;
  CorotatedMotion<LinearElastic, float> ours(pressing.body, scene, options);
  BulletBlock theirs(pressing);
  std::vector<double> own, other;
  const NodeId top = pressing.block.touched.front();
  double apart = 0.0, deepest = 0.0;
  const double rest = pressing.body.rest.mesh.position(top).z();
  for (int k = 0; k * h < together; ++k) {
    own.push_back(bench::seconds_of([&] { ours.step(h); }));
    other.push_back(bench::seconds_of([&] { theirs.step(); }));
    const double sunk = ours.displacement()[3 * Index{top} + 2];
    deepest = std::max(deepest, std::abs(sunk));
    apart = std::max(apart, std::abs(theirs.height(top) - rest - sunk));
  }
  const double us = bench::percentile(own, 0.5), them = bench::percentile(other, 0.5);
  char text[80];
  std::snprintf(text, sizeof text, ", largest difference %.0f %% in %.1f s", 100.0 * apart / deepest, together);
  rows.add({.target = "n",
            .what = "step of 1 ms of a block under its weight against Bullet, " +
                    std::to_string(pressing.body.rest.mesh.element_count()) + " tets",
            .figure = bench::milliseconds(us),
            .baseline = bench::milliseconds(them) + text,
            .ratio = them / us,
            .bound = {},
            .error = apart <= 0.25 * deepest ? "" : "the two motions differ"});
}

#else

void measure_bullet(bench::RowFile& rows, int n) {
  rows.skip("n", "step of 1 ms against Bullet, " + std::to_string(6 * n * n * n) + " tets",
            "Bullet is not installed (libbullet-dev)");
}

#endif

}  // namespace implicit_path
