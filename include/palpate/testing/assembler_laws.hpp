// The laws of StiffnessOperator (concepts/linear_solver.hpp).
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/testing/dense.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/violation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// The dense matrix of an operator, computed column by column with `apply`. For small operators.
template <class Op>
MatrixX dense_matrix(const Op& op) {
  const Index n = op.size();
  MatrixX k(n, n);
  VectorX x = VectorX::Zero(n), y(n);
  for (Index j = 0; j < n; ++j) {
    x[j] = 1.0;
    op.apply(x, y);
    k.col(j) = y;
    x[j] = 0.0;
  }
  return k;
}

/// Entries in [-1, 1].
VectorX random_vector(Random& random, Index n);

/// A displacement of all nodes: u = shift + gradient (x - x_0), x_0 the first node.
template <Element E>
VectorX affine_displacement(const Mesh<E>& mesh, const Vector3& shift, const Matrix3& gradient) {
  const Vector3 origin = mesh.position(0);
  VectorX u(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i)
    u.template segment<3>(3 * i) = shift + gradient * (mesh.position(i) - origin);
  return u;
}

/// "symmetric", "diagonal blocks agree" with the columns, "apply overwrites" the previous content of y, and "apply is
/// linear".
template <StiffnessOperator K>
Violations operator_laws(const K& k, const MatrixX& dense) {
  Violations v;
  const Index n = k.size();
  const double scale = dense.cwiseAbs().maxCoeff();
  expect_at_most(v, "symmetric", (dense - dense.transpose()).cwiseAbs().maxCoeff(), 1e-13 * scale);
  const std::vector<Matrix3> blocks = k.diagonal_blocks();
  expect_true(v, "diagonal blocks agree", static_cast<Index>(blocks.size()) == n / 3, "number of blocks");
  Worst worst("diagonal blocks agree", 1e-13 * scale);
  for (Index i = 0; i < std::min<Index>(n / 3, static_cast<Index>(blocks.size())); ++i)
    worst.observe((blocks[static_cast<std::size_t>(i)] - dense.block<3, 3>(3 * i, 3 * i)).cwiseAbs().maxCoeff(),
                  [i] { return "node " + std::to_string(i); });
  worst.report(v);
  Random random(1822);
  const VectorX x = random_vector(random, n);
  VectorX clean = VectorX::Zero(n), dirty = VectorX::Constant(n, std::numeric_limits<double>::quiet_NaN());
  k.apply(x, clean);
  k.apply(x, dirty);
  expect_true(v, "apply overwrites", clean == dirty);
  expect_at_most(v, "apply is linear", (clean - dense * x).cwiseAbs().maxCoeff(),
                 1e-13 * scale * static_cast<double>(n));
  return v;
}

/// "translation costs nothing" and "rotation costs nothing": K times a rigid motion is negligible compared with |K|
/// times its size.
template <Element E, StiffnessOperator K>
Violations rigid_motion_laws(const Mesh<E>& mesh, const K& k, double scale) {
  Violations v;
  VectorX force(k.size());
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 e = Vector3::Unit(axis);
    Matrix3 spin = Matrix3::Zero();
    spin((axis + 2) % 3, (axis + 1) % 3) = 1.0;
    spin((axis + 1) % 3, (axis + 2) % 3) = -1.0;
    const std::string name = std::string("axis ") + "xyz"[axis];
    for (const bool turn : {false, true}) {
      const VectorX u = affine_displacement(mesh, turn ? Vector3::Zero() : e, turn ? spin : Matrix3(Matrix3::Zero()));
      k.apply(u, force);
      expect_at_most(v, turn ? "rotation costs nothing" : "translation costs nothing", force.cwiseAbs().maxCoeff(),
                     1e-12 * scale * u.cwiseAbs().maxCoeff(), name);
    }
  }
  return v;
}

/// "exact zero modes": as many eigenvalues below rounding as rigid motions, all others positive. O(n^3).
Violations zero_mode_laws(const MatrixX& dense, Index rigid_motions);

/// "affine patch": for u = a + A x with a far from zero, the nodal forces of a uniform body are those of the stress on
/// its boundary, and zero inside; and "affine energy": u K u = sum of V e : D e, for any materials. The forces come
/// from face integrals, the volumes from the mass rule: neither uses the stiffness.
template <Element E, StiffnessOperator K>
Violations affine_patch_laws(const Body<E>& body, const K& k, double scale) {
  Violations v;
  Random random(1957);
  for (int trial = 0; trial < 4; ++trial) {
    Matrix3 a;
    for (int i = 0; i < 3; ++i) a.col(i) = random.vector<3>(-1.0, 1.0);
    VectorX size = affine_displacement(body.mesh, Vector3::Zero(), a);
    const Vector3 shift = 10.0 * size.cwiseAbs().maxCoeff() * random.vector<3>(-1.0, 1.0);
    const VectorX u = affine_displacement(body.mesh, shift, a);
    VectorX force(k.size());
    k.apply(u, force);
    const Vector6 strain = voigt::strain_vector(0.5 * (a + a.transpose()));
    double energy = 0.0, bound = 1e-12 * scale * u.cwiseAbs().maxCoeff();
    for (Index e = 0; e < body.mesh.element_count(); ++e)
      energy += palpate::detail::shape_volumes<E>(element_nodes<E>(body.mesh, e)).sum() *
                strain.dot(body.elasticity_of(e) * strain);
    const std::string name = "trial " + std::to_string(trial);
    expect_at_most(v, "affine energy", std::abs(size.dot(force) - energy), bound * size.cwiseAbs().sum(), name);
    bool uniform = true;
    for (const Matrix6& d : body.elasticity) uniform = uniform && d == body.elasticity.front();
    if (!uniform) continue;
    const Matrix3 stress = voigt::stress_tensor(body.elasticity.front() * strain);
    for (const BoundaryFace& face : extract_boundary<E>(body.mesh))
      palpate::detail::with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
        const auto areas = palpate::detail::shape_area_vectors<F>(palpate::detail::face_nodes<F>(body.mesh, face));
        for (int i = 0; i < F::nodes; ++i)
          force.template segment<3>(3 * Index{face.nodes[static_cast<std::size_t>(i)]}) -=
              stress * areas.row(i).transpose();
      });
    expect_at_most(v, "affine patch", force.cwiseAbs().maxCoeff(), bound, name);
  }
  return v;
}

/// Laws of one stiffness of a whole body: size, finiteness, the operator laws, rigid motions, zero modes (six per
/// piece) and the affine patch test. Builds the dense matrix: for bodies up to a few hundred nodes.
template <Element E, StiffnessOperator K>
Violations stiffness_laws(const Body<E>& body, const K& k, Index pieces = 1) {
  Violations v;
  expect_true(v, "size", static_cast<Index>(k.size()) == 3 * body.mesh.node_count());
  expect_above(v, "bytes", static_cast<double>(k.bytes()), 0.0);
  if (!v.empty()) return v;
  const MatrixX dense = dense_matrix(k);
  expect_true(v, "finite", dense.allFinite());
  if (!v.empty()) return v;
  const double scale = dense.cwiseAbs().maxCoeff();
  append(v, operator_laws(k, dense));
  append(v, rigid_motion_laws(body.mesh, k, scale));
  append(v, zero_mode_laws(dense, 6 * pieces));
  append(v, affine_patch_laws(body, k, scale));
  return v;
}

/// "products agree" and "diagonal blocks agree" of two stiffnesses of the same body, such as a stored and a matrix-free
/// one.
template <StiffnessOperator A, StiffnessOperator B>
Violations same_stiffness_laws(const A& a, const B& b, double tolerance = 1e-13) {
  Violations v;
  expect_true(v, "size", static_cast<Index>(a.size()) == static_cast<Index>(b.size()));
  if (!v.empty()) return v;
  Random random(1946);
  VectorX ya(a.size()), yb(a.size());
  for (int trial = 0; trial < 4; ++trial) {
    const VectorX x = random_vector(random, a.size());
    a.apply(x, ya);
    b.apply(x, yb);
    expect_at_most(v, "products agree", (ya - yb).norm(), tolerance * ya.norm(), "trial " + std::to_string(trial));
  }
  const auto da = a.diagonal_blocks(), db = b.diagonal_blocks();
  expect_true(v, "diagonal blocks agree", da.size() == db.size(), "number of blocks");
  Worst worst("diagonal blocks agree", tolerance);
  for (std::size_t i = 0; i < std::min(da.size(), db.size()); ++i)
    worst.observe((da[i] - db[i]).norm() / da[i].norm(), [i] { return "node " + std::to_string(i); });
  worst.report(v);
  return v;
}

inline VectorX random_vector(Random& random, Index n) {
  VectorX v(n);
  for (Index i = 0; i < n; ++i) v[i] = random.uniform(-1.0, 1.0);
  return v;
}

inline Violations zero_mode_laws(const MatrixX& dense, Index rigid_motions) {
  Violations v;
  const VectorX lambda = symmetric_eigenvalues(dense);
  const double rounding = 1e-13 * lambda[lambda.size() - 1] * std::sqrt(static_cast<double>(lambda.size()));
  Index zero = 0;
  for (Index i = 0; i < lambda.size(); ++i) zero += std::abs(lambda[i]) <= rounding ? 1 : 0;
  expect_true(v, "exact zero modes", zero == rigid_motions,
              std::to_string(zero) + " instead of " + std::to_string(rigid_motions));
  expect_at_least(v, "no negative mode", lambda[0], -rounding);
  return v;
}

}}}  // namespace palpate::testing
