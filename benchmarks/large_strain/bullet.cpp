// Bullet's deformable bodies, as a baseline.
#include "pressed_block.hpp"

#ifdef PALPATE_BENCH_BULLET
#include "../common/bullet_body.hpp"

namespace large_strain {
namespace {

/// Bullet's neo-Hookean law (Smith et al. 2018 with the logarithmic term). Its constants in terms of Lame's are those
/// of section 3.4 there, so that it agrees with linear elasticity at small strain.
struct LogarithmicStableNeoHookean {
  double mu = 4.0 / 3.0 * bench::tissue.shear_modulus(),
         lambda = bench::tissue.lame_lambda() + 5.0 / 6.0 * bench::tissue.shear_modulus();

  Matrix3 operator()(const Matrix3& f) const {
    return mu * (1.0 - 1.0 / (f.squaredNorm() + 1.0)) * f +
           (lambda * (f.determinant() - 1.0) - 0.75 * mu) * StableNeoHookean::cofactor(f);
  }
};

class BulletBlock : public Method {
 public:
  BulletBlock(const PressedBlock& block, std::unique_ptr<btDeformableLagrangianForce> elasticity,
              std::function<Matrix3(const Matrix3&)> stress)
      : mesh_(block.mesh), square_(block.square), stress_(std::move(stress)) {
    std::vector<NodeId> constrained = block.bottom;
    constrained.insert(constrained.end(), square_.begin(), square_.end());
    body_ = std::make_unique<bench::BulletBody>(mesh_, lumped_mass(make_body(mesh_, std::vector{bench::tissue})),
                                                constrained, std::move(elasticity), 0.0);
  }
  void step(const Vector3& square) override {
    for (const NodeId i : square_) body_->place(i, mesh_.position(Index{i}) + square);
    body_->step(step_length);
  }
  Vector3 force() override {
    return elastic_force(
        mesh_, square_, [&](NodeId i) { return body_->position(i); }, stress_);
  }

 private:
  Mesh<Tet4> mesh_;
  std::vector<NodeId> square_;
  std::function<Matrix3(const Matrix3&)> stress_;
  std::unique_ptr<bench::BulletBody> body_;
};

}  // namespace

void add_bullet(std::vector<Entry>& entries) {
  entries.push_back({"Bullet, co-rotated", "#36c", [](const PressedBlock& block) {
                       return std::make_unique<BulletBlock>(
                           block,
                           std::make_unique<btDeformableLinearElasticityForce>(
                               static_cast<btScalar>(bench::tissue.shear_modulus()),
                               static_cast<btScalar>(bench::tissue.lame_lambda()), btScalar(0), btScalar(0)),
                           corotated_stress);
                     }});
  entries.push_back({"Bullet, neo-Hookean", "#93c", [](const PressedBlock& block) {
                       const LogarithmicStableNeoHookean law;
                       return std::make_unique<BulletBlock>(
                           block,
                           std::make_unique<btDeformableNeoHookeanForce>(
                               static_cast<btScalar>(law.mu), static_cast<btScalar>(law.lambda), btScalar(0)),
                           law);
                     }});
}

}  // namespace large_strain

#else

namespace large_strain {

void add_bullet(std::vector<Entry>&) {}

}  // namespace large_strain

#endif
