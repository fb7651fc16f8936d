// A factor of a body, used for the same body when its parts have turned.
#pragma once

#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>
#include <palpate/model/static/detail/nodal_rotation.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// z = R A^-1 R^T r with a factor of A and a rotation per node. Exact for a body that turns as a whole, good where
/// neighbours turn alike. O(nodes) beside the solve; allocates when it is made only.
class TurnedSolve {
 public:
  explicit TurnedSolve(const DeformableBody& body);

  const EssentialConditions& conditions() const noexcept { return conditions_; }

  /// How far every node has turned under a displacement [m].
  void fit(const VectorX& u, std::vector<Matrix3>& turn) const noexcept;
  /// Turns by what u does, for a factor of the body at rest.
  void turn(const VectorX& u) noexcept { fit(u, turn_); }
  /// The same for a factor of the body where its nodes had turned by `since`.
  void turn(const VectorX& u, const std::vector<Matrix3>& since) noexcept;

  /// Vectors have 3 entries per node; z is zero on held dofs.
  void solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept;

 private:
  static std::vector<NodeId> all_nodes(std::size_t count);

  EssentialConditions conditions_;
  NodalRotations rotations_;
  std::vector<Matrix3> turn_;
  VectorX full_, x_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/turned_solve.ipp>
#endif
