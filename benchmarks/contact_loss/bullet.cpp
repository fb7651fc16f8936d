// The scenes with Bullet 3.24: btDeformableMultiBodyDynamicsWorld with co-rotated linear elasticity. It is the only
// world of Bullet whose soft bodies have Young's modulus and Poisson ratio: those of btSoftRigidDynamicsWorld have
// coefficients from 0 to 1 (m_kLST, m_kVST), and their stiffness depends on the number of iterations.
//
// Settings: those of Bullet's demos of deformable volumes (examples/DeformableDemo), with the variant that settled most
// often here: contact of faces (SDF_RDF), elastic forces explicit and damping implicit. With contact of nodes only
// (SDF_RDN) spheres smaller than the facets pass between the nodes; with implicit elastic forces, contacts of faces did
// not settle. The tool is a kinematic body with a motion state, and lengths are in centimetres, since moving objects
// should not be much smaller than 0.2 units (Bullet 2.83 Physics SDK Manual, "Kinematic Bodies" and "Avoid very small
// and very large collision shapes"). Damping is critical for a shear wave across the body. All nodes have the same
// mass, as contacts of faces assume (btSoftBodyInternals.h, CollideSDF_RDF).
//
// Bullet cannot detect contact of rigid and deformable bodies between steps (its CCD is for pairs of rigid or pairs of
// deformable bodies), give the compliance of a body, or stop the tool at the surface: a kinematic tool goes where the
// device is. Debian's package computes in single precision.
#include "scenes.hpp"

#ifdef PALPATE_BENCH_BULLET
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <LinearMath/btDefaultMotionState.h>

#include <memory>
#include <numbers>
#endif

namespace contact_loss {

#ifdef PALPATE_BENCH_BULLET
namespace {

// Centimetre, tonne, second. Bullet's conjugate gradients stop at a tolerance that is relative to energies below one
// unit, and absolute above; with grams they would always run to their limit of 300 iterations.
constexpr double length = 1e2, mass = 1e-3, force = mass * length, pressure = mass / length;

btVector3 in_units(const Vector3& p) {
  return {btScalar(length * p.x()), btScalar(length * p.y()), btScalar(length * p.z())};
}
Vector3 in_si(const btVector3& v, double unit) {
  return Vector3(static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())) / unit;
}

class BulletScene {
 public:
  BulletScene(const Scene& scene, Features features)
      : scene_(scene),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_, &deformable_),
        shape_(btScalar(length * scene.radius)),
        motion_(btTransform(btQuaternion::getIdentity(), in_units(scene.path.front()))),
        tool_(btRigidBody::btRigidBodyConstructionInfo(0, &motion_, &shape_)) {
    set_up_world();
    add_tissue(features);
    tool_.setCollisionFlags(tool_.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    tool_.setActivationState(DISABLE_DEACTIVATION);
    tool_.setFriction(0);
    world_.addRigidBody(&tool_);
  }
  ~BulletScene() {
    world_.removeRigidBody(&tool_);
    world_.removeSoftBody(body_.get());
  }
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;

  void step(const Vector3& centre) {
    motion_.setWorldTransform(btTransform(btQuaternion::getIdentity(), in_units(centre)));
    world_.stepSimulation(btScalar(tick), 1, btScalar(tick));
  }
  int contacts() const { return body_->m_nodeRigidContacts.size() + body_->m_faceRigidContacts.size(); }
  /// Force on the tool [N], from the elastic forces on the supported nodes: equal to the contact force at rest, and
  /// smoother in motion.
  Vector3 tool_force() {
    forces_.resize(body_->m_nodes.size());
    for (int i = 0; i < forces_.size(); ++i) forces_[i].setZero();
    elasticity_->addScaledElasticForce(btScalar(1), forces_);
    Vector3 sum = Vector3::Zero();
    for (const NodeId node : scene_.constrained) sum -= in_si(forces_[body_->m_nodes[node].index], force);
    return sum;
  }
  VectorX displacement() const {
    VectorX u(3 * scene_.mesh.node_count());
    for (NodeId i = 0; i < scene_.mesh.node_count(); ++i)
      u.segment<3>(3 * Index{i}) = in_si(body_->m_nodes[i].m_x, length) - scene_.mesh.position(i);
    return u;
  }

 private:
  void set_up_world() {
    solver_.setDeformableSolver(&deformable_);
    world_.setGravity(btVector3(0, 0, 0));
    world_.getWorldInfo().m_gravity.setZero();
    world_.getWorldInfo().m_sparsesdf.setDefaultVoxelsz(btScalar(0.125 * length * scene_.radius));
    world_.getWorldInfo().m_sparsesdf.Reset();
    world_.setImplicit(false);
    world_.setLineSearch(false);
    world_.setUseProjection(true);
    btContactSolverInfo& info = world_.getSolverInfo();
    info.m_deformable_erp = btScalar(0.3);
    info.m_deformable_maxErrorReduction = btScalar(200);
    info.m_leastSquaresResidualThreshold = btScalar(1e-4);
    info.m_splitImpulse = true;
    info.m_numIterations = 100;
  }

  void add_tissue(Features features) {
    std::vector<btVector3> x;
    for (const Vector3& p : scene_.mesh.positions) x.push_back(in_units(p));
    double volume = 0.0;
    for (const auto& e : scene_.mesh.elements) {
      Matrix3 edges;
      for (std::size_t c = 0; c < 3; ++c)
        edges.col(static_cast<Index>(c)) = scene_.mesh.position(e[c + 1]) - scene_.mesh.position(e[0]);
      volume += edges.determinant() / 6.0;
    }
    const double share = mass * scene_.material.density * volume / static_cast<double>(x.size());
    const std::vector<btScalar> masses(x.size(), static_cast<btScalar>(share));
    body_ = std::make_unique<btSoftBody>(&world_.getWorldInfo(), static_cast<int>(x.size()), x.data(), masses.data());
    for (const auto& e : scene_.mesh.elements) body_->appendTetra(e[0], e[1], e[2], e[3]);
    add_links();
    // All faces must be connected, or Bullet's tree of faces is never complete.
    for (const auto& t : scene_.outer) body_->appendFace(t[0], t[1], t[2]);
    for (const NodeId node : scene_.constrained) body_->setMass(node, 0);
    body_->initializeDmInverse();
    body_->m_tetraScratches.resize(body_->m_tetras.size());
    body_->m_tetraScratchesTn.resize(body_->m_tetras.size());
    body_->getCollisionShape()->setMargin(btScalar(0.01 * length * scene_.radius));
    body_->m_cfg.kKHR = body_->m_cfg.kCHR = 1;
    body_->m_cfg.kDF = 0;
    body_->m_cfg.collisions = btSoftBody::fCollision::SDF_RD;
    if (features != Features::faces) body_->m_cfg.collisions |= btSoftBody::fCollision::SDF_RDN;
    if (features != Features::nodes) body_->m_cfg.collisions |= btSoftBody::fCollision::SDF_RDF;
    body_->setSelfCollision(false);
    body_->m_sleepingThreshold = 0;
    body_->setActivationState(DISABLE_DEACTIVATION);
    world_.addSoftBody(body_.get());
    const LinearElastic& m = scene_.material;
    const double slowest = 0.5 * std::numbers::pi * std::sqrt(m.shear_modulus() / m.density) / scene_.height;
    elasticity_ = std::make_unique<btDeformableLinearElasticityForce>(btScalar(pressure * m.shear_modulus()),
                                                                      btScalar(pressure * m.lame_lambda()),
                                                                      btScalar(slowest), btScalar(1.0 / slowest));
    world_.addForce(body_.get(), elasticity_.get());
  }

  /// The edges, without stiffness: Bullet's tree of nodes requires that links join all nodes, or is never complete.
  void add_links() {
    std::vector<std::pair<NodeId, NodeId>> edges;
    for (const auto& e : scene_.mesh.elements)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) edges.emplace_back(std::minmax(e[i], e[j]));
    std::ranges::sort(edges);
    edges.erase(std::ranges::unique(edges).begin(), edges.end());
    for (const auto& [a, b] : edges) body_->appendLink(a, b);
  }

  const Scene& scene_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver solver_;
  btDeformableMultiBodyDynamicsWorld world_;
  btSphereShape shape_;
  btDefaultMotionState motion_;
  btRigidBody tool_;
  std::unique_ptr<btDeformableLinearElasticityForce> elasticity_;
  std::unique_ptr<btSoftBody> body_;
  btAlignedObjectArray<btVector3> forces_;
};

}  // namespace

bool has_bullet() {
  return true;
}

Counts run_bullet(const Scene& scene, Features features) {
  BulletScene bullet(scene, features);
  Judge judge(scene);
  for (const Vector3& centre : scene.path) {
    bullet.step(centre);
    const bool finite = bullet.displacement().allFinite();
    if (!judge.note(finite ? bullet.tool_force() : Vector3::Constant(infinity), bullet.contacts() > 0)) break;
    if (judge.ends_hold()) judge.end_hold(bullet.displacement(), centre);
  }
  return judge.counts();
}
#else
bool has_bullet() {
  return false;
}
Counts run_bullet(const Scene&, Features) {
  return {};
}
#endif

}  // namespace contact_loss
