// The measurements of the program.
#pragma once

#include <palpate/model/moving/detail/corotated_motion.hpp>

#include "../common/bodies.hpp"
#include "../common/row.hpp"
#include "../common/timing.hpp"

#include <memory>
#include <numbers>

namespace implicit_path {

using namespace palpate;

using Corotated = Corotational;

/// The standard block under its weight, fixed at the bottom; a patch in the middle of its top is pressed 20 mm down and
/// up again, twice a second.
struct Pressing {
  bench::SupportedBody block;
  HyperelasticBody<Tet4, Corotated> body;
  Scene scene;

  explicit Pressing(int n)
      : block(bench::standard_block(n)),
        body(make_hyperelastic_body(
            block.mesh, std::vector<Corotated>{
                            {bench::tissue.youngs_modulus, bench::tissue.poisson_ratio, bench::tissue.density}})) {
    scene.fix(block.constrained).fix(block.touched).gravity(Vector3(0.0, 0.0, -9.81));
  }
  double tets() const { return static_cast<double>(body.rest.mesh.element_count()); }
  /// Prescribed displacement of the prescribed dofs at a time [m]; 3 per node.
  VectorX prescribed_at(double time) const {
    VectorX u = VectorX::Zero(3 * body.rest.mesh.node_count());
    for (const NodeId node : block.touched)
      u[3 * Index{node} + 2] = -0.01 * (1.0 - std::cos(4.0 * std::numbers::pi * time));
    return u;
  }
  /// Force on the patch [N]: the sum of the nodal forces `resistance` on it.
  Vector3 force_on_patch(const VectorX& resistance) const {
    Vector3 sum = Vector3::Zero();
    for (const NodeId node : block.touched) sum += resistance.segment<3>(3 * Index{node});
    return sum;
  }
};

/// A straightforward step with Eigen: closest rotations by Mueller's iteration (2016), started from the previous ones;
/// the stiffness of every element is rotated and added to a sparse matrix at precomputed positions; Eigen's conjugate
/// gradients with its diagonal preconditioner.
class PlainEigenStep {
 public:
  PlainEigenStep(const Pressing& pressing, double tolerance);
  void set_state(const VectorX& u, const VectorX& v) {
    u_ = u;
    v_ = v;
  }
  void step(double h, const VectorX& prescribed);
  const VectorX& displacement() const noexcept { return u_; }
  const VectorX& velocity() const noexcept { return v_; }
  long iterations() const noexcept { return iterations_; }

 private:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  struct Element {
    std::array<NodeId, 4> nodes;
    Eigen::Matrix<double, 4, 3> gradient;
    Matrix12 stiffness;
    double volume = 0.0;
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    std::array<Index, 144> place;  // index of every entry among the values; -1: prescribed
  };
  void rotate(Element& e) const;
  void add(Element& e, const VectorX& predicted, VectorX& residual);

  std::vector<Element> elements_;
  EssentialConditions conditions_;
  VectorX mass_, load_, u_, v_;
  SparseMatrix a_;
  std::vector<Index> diagonal_;
  double tolerance_;
  long iterations_ = 0;
};

/// Rows (n) and (o): steps of a block with n cells per side compared with plain Eigen, and the error of every short
/// cut.
void measure_steps(bench::RowFile& rows, int n, double budget);
/// The same block under its weight in Bullet, where Bullet is installed.
void measure_bullet(bench::RowFile& rows, int n);
/// Block Jacobi compared with the co-rotated factor, for several time steps.
void measure_preconditioners(bench::RowFile& rows, int n);
/// The largest block whose step of a millisecond takes at most a millisecond, by material and integrator.
void measure_largest(bench::RowFile& rows);

}  // namespace implicit_path
