// A factor of a body, used for the same body when its parts have turned.
#pragma once

#include <palpate/model/deformable_body.hpp>
#include <palpate/model/nodal_rotation.hpp>
#include <palpate/model/tangent_solver.hpp>

#include <numeric>

namespace palpate { inline namespace PALPATE_ABI {

/// z = R A^-1 R^T r with a factor of A and a rotation per node. Exact for a body that turns as a whole, good where
/// neighbours turn alike. O(nodes) beside the solve; allocates when it is made only.
class TurnedSolve {
 public:
  explicit TurnedSolve(const DeformableBody& body)
      : conditions_(body.conditions),
        rotations_(body.pattern, body.positions, all_nodes(body.positions.size())),
        turn_(body.positions.size(), Matrix3::Identity()),
        full_(3 * static_cast<Index>(body.positions.size())),
        x_(conditions_.free_count()) {}

  const EssentialConditions& conditions() const noexcept { return conditions_; }

  /// How far every node has turned under a displacement [m].
  void fit(const VectorX& u, std::vector<Matrix3>& turn) const noexcept {
    for (std::size_t i = 0; i < turn.size(); ++i) turn[i] = rotations_(i, u);
  }
  /// Turns by what u does, for a factor of the body at rest.
  void turn(const VectorX& u) noexcept { fit(u, turn_); }
  /// The same for a factor of the body where its nodes had turned by `since`.
  void turn(const VectorX& u, const std::vector<Matrix3>& since) noexcept {
    fit(u, turn_);
    for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = turn_[i] * since[i].transpose();
  }

  /// Vectors have 3 entries per node; z is zero on held dofs.
  void solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept {
    for (std::size_t i = 0; i < turn_.size(); ++i) {
      const auto at = 3 * static_cast<Index>(i);
      full_.segment<3>(at).noalias() = turn_[i].transpose() * r.segment<3>(at);
    }
    conditions_.gather(full_, x_);
    factor.solve(x_, x_);
    conditions_.scatter(x_, full_);
    for (std::size_t i = 0; i < turn_.size(); ++i) {
      const auto at = 3 * static_cast<Index>(i);
      z.segment<3>(at).noalias() = turn_[i] * full_.segment<3>(at);
    }
    for (Index dof = 0; dof < z.size(); ++dof)
      if (conditions_.is_constrained(dof)) z[dof] = 0.0;
  }

 private:
  static std::vector<NodeId> all_nodes(std::size_t count) {
    std::vector<NodeId> nodes(count);
    std::iota(nodes.begin(), nodes.end(), NodeId{0});
    return nodes;
  }

  EssentialConditions conditions_;
  NodalRotations rotations_;
  std::vector<Matrix3> turn_;
  VectorX full_, x_;
};

}}  // namespace palpate
