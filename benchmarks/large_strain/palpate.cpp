// palpate's moving tissue.
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "pressed_block.hpp"

#include <Eigen/SVD>

namespace large_strain {
namespace {

const NeoHookean law{bench::tissue.youngs_modulus, bench::tissue.poisson_ratio, bench::tissue.density};

/// The block as a mesh of elements E.
template <Element E>
Mesh<E> mesh_of(const PressedBlock& block) {
  if constexpr (E::nodes == 10)
    return promote<E>(block.mesh);
  else
    return copy_mesh<E>(block.mesh);
}

template <Element E, class S>
class QuasiNewtonBlock : public Method {
 public:
  QuasiNewtonBlock(const PressedBlock& block, const QuasiNewtonParameters& parameters)
      : body_(make_hyperelastic_body(mesh_of<E>(block), std::vector{law})) {
    const Mesh<E>& mesh = body_.rest.mesh;
    for (Index i = 0; i < mesh.node_count(); ++i) {
      if (PressedBlock::on_bottom(mesh.position(i))) bottom_.push_back(static_cast<NodeId>(i));
      if (PressedBlock::in_square(mesh.position(i))) square_.push_back(static_cast<NodeId>(i));
    }
    Scene scene;
    scene.fix(bottom_).fix(square_);
    motion_ = SolverTraits<Implicit<QuasiNewton<S>>>::make_motion(body_, scene, parameters, SetupLimits{}).motion;
    prescribed_ = f_ = VectorX::Zero(3 * mesh.node_count());
    exact_ = palpate::detail::make_energy_forces<double>(body_, SetupLimits{});
  }
  void step(const Vector3& square) override {
    for (const NodeId i : square_) set_node_vector(prescribed_, Index{i}, square);
    motion_->set_prescribed(prescribed_);
    if (!motion_->step(step_length).taken) raise(SetupErrorKind::not_converged, "a step was not taken");
  }
  Vector3 force() override {
    DeformationReport report;
    exact_->evaluate(motion_->displacement(), f_, report);
    Vector3 sum = Vector3::Zero();
    for (const NodeId i : square_) sum += node_vector(f_, Index{i});
    return sum;
  }

 private:
  HyperelasticBody<E, NeoHookean> body_;
  std::vector<NodeId> bottom_, square_;
  std::unique_ptr<TissueMotion> motion_;
  std::unique_ptr<detail::EnergyForces> exact_;
  VectorX prescribed_, f_;
};

const Corotational corotational{bench::tissue.youngs_modulus, bench::tissue.poisson_ratio, bench::tissue.density};

/// Co-rotated tetrahedra without a factorisation.
class CorotatedBlock : public Method {
 public:
  explicit CorotatedBlock(const PressedBlock& block) : mesh_(block.mesh), square_(block.square) {
    Scene scene;
    scene.fix(block.bottom).fix(square_);
    motion_ = SolverTraits<Implicit<MatrixFreeCG<BlockJacobi>>>::make_motion(
                  make_hyperelastic_body(mesh_, std::vector{corotational}), scene, {.step = step_length}, SetupLimits{})
                  .motion;
    prescribed_ = VectorX::Zero(3 * mesh_.node_count());
  }
  void step(const Vector3& square) override {
    for (const NodeId i : square_) set_node_vector(prescribed_, Index{i}, square);
    motion_->set_prescribed(prescribed_);
    motion_->step(step_length);
  }
  Vector3 force() override {
    const auto place = [&](NodeId i) {
      return Vector3(mesh_.position(Index{i}) + node_vector(motion_->displacement(), Index{i}));
    };
    return elastic_force(mesh_, square_, place,
                         [](const Matrix3& f) { return matrix3(corotational.stress(tensor3<double>(f))); });
  }

 private:
  Mesh<Tet4> mesh_;
  std::vector<NodeId> square_;
  std::unique_ptr<TissueMotion> motion_;
  VectorX prescribed_;
};

}  // namespace

Matrix3 corotated_stress(const Matrix3& f) {
  const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3 signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  const Matrix3 r = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const Matrix3 stretch = r.transpose() * f - Matrix3::Identity();
  return r * (bench::tissue.shear_modulus() * (stretch + stretch.transpose()) +
              bench::tissue.lame_lambda() * stretch.trace() * Matrix3::Identity());
}

void add_palpate(std::vector<Entry>& entries) {
  const auto add = [&]<Element E, class S>(const char* name, const char* colour, int largest,
                                           const QuasiNewtonParameters& parameters) {
    entries.push_back({name, colour,
                       [parameters](const PressedBlock& block) {
                         return std::make_unique<QuasiNewtonBlock<E, S>>(block, parameters);
                       },
                       largest});
  };
  add.operator()<Smoothed<Tet4>, float>("palpate, Smoothed<Tet4>, float", "#0b6", 16, {.inertia = false});
  add.operator()<Smoothed<Tet4>, float>("palpate, Smoothed<Tet4>, float, with inertia", "#6c3", 16, {});
  add.operator()<Tet10, double>("palpate, Tet10", "#075", 8, {.inertia = false});
  entries.push_back({"palpate, co-rotated Tet4", "#9c9",
                     [](const PressedBlock& block) { return std::make_unique<CorotatedBlock>(block); }});
}

std::vector<Vector3> reference_forces(int n, int every) {
  QuasiNewtonBlock<Tet10, double> block(PressedBlock(n),
                                        {.inertia = false, .maximum_iterations = 300, .tolerance = 1e-5});
  std::vector<Vector3> forces;
  for (int k = every; k * step_length < duration; k += every) {
    block.step(PressedBlock::path(k * step_length));
    forces.push_back(block.force());
  }
  return forces;
}

}  // namespace large_strain
