// Uses a factor of a body for the same body after its parts have rotated.
#pragma once

#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/detail/nodal_rotation.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <Eigen/LU>

#include <numeric>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// z = R A^-1 R^T r with a factor of A and a rotation R per node. Exact for a rigid rotation, accurate where neighbours
/// have similar rotations. O(nodes) in addition to the solve; only the constructor allocates.
class CorotatedSolve {
 public:
  /// With a stiffness, rotations follow the stiffer ones of the parts around a node; see NodalRotations.
  explicit CorotatedSolve(const DeformableBody& body, const BlockMatrix* stiffness = nullptr)
      : conditions_(body.conditions),
        rotations_(body.pattern, body.positions, all_nodes(body.positions.size()), stiffness),
        rotation_(body.positions.size(), Matrix3::Identity()),
        full_(3 * static_cast<Index>(body.positions.size())),
        x_(conditions_.free_count()) {}

  const EssentialConditions& conditions() const noexcept { return conditions_; }

  /// The rotation of every node under a displacement [m].
  void fit(const VectorX& u, std::vector<Matrix3>& rotation) const noexcept {
    for (std::size_t i = 0; i < rotation.size(); ++i) rotation[i] = rotations_(i, u);
  }
  /// Sets the rotations from u [m], for a factor of the body at rest.
  void update(const VectorX& u) noexcept { fit(u, rotation_); }
  /// The same for a factor of the body whose nodes were rotated by `since`.
  void update(const VectorX& u, const std::vector<Matrix3>& since) noexcept {
    fit(u, rotation_);
    for (std::size_t i = 0; i < rotation_.size(); ++i) rotation_[i] = rotation_[i] * since[i].transpose();
  }
  /// Sets deformation gradients in place of rotations, for a factor of the body at rest, where they are moderate. They
  /// map displacements without a change of volume to such ones (Piola), so that the solve stays near the inverse for
  /// nearly incompressible tissue that is stretched. For other tissue rotations are nearer.
  void update_stretched(const VectorX& u) noexcept;

  /// Vectors have 3 entries per node; z is zero on constrained dofs.
  void solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept;
  /// y = R A R^T x.
  void apply(const BlockMatrix& a, const VectorX& x, VectorX& y) noexcept;

 private:
  static std::vector<NodeId> all_nodes(std::size_t count) {
    std::vector<NodeId> nodes(count);
    std::iota(nodes.begin(), nodes.end(), NodeId{0});
    return nodes;
  }

  EssentialConditions conditions_;
  NodalRotations rotations_;
  std::vector<Matrix3> rotation_;
  VectorX full_, x_;
};

inline void CorotatedSolve::update_stretched(const VectorX& u) noexcept {
  constexpr double most = 3.0;  // change of volume, and mean square stretch
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const Matrix3 f = rotations_.gradient(i, u);
    const double volume = f.determinant();
    const bool moderate = volume > 1.0 / most && volume < most && f.squaredNorm() < 3.0 * most;
    rotation_[i] = moderate ? f : rotations_(i, u);
  }
}

inline void CorotatedSolve::solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept {
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(full_, node, rotation_[i].transpose() * node_vector(r, node));
  }
  conditions_.gather(full_, x_);
  factor.solve(x_, x_);
  conditions_.scatter(x_, full_);
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(z, node, rotation_[i] * node_vector(full_, node));
  }
  for (Index dof = 0; dof < z.size(); ++dof)
    if (conditions_.is_constrained(dof)) z[dof] = 0.0;
}

inline void CorotatedSolve::apply(const BlockMatrix& a, const VectorX& x, VectorX& y) noexcept {
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(full_, node, rotation_[i].transpose() * node_vector(x, node));
  }
  a.apply(full_, y);
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(y, node, rotation_[i] * node_vector(y, node));
  }
}

}}}  // namespace palpate::detail
