// Uses a factor of a body for the same body after its parts have rotated.
#pragma once

#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>
#include <palpate/model/detail/nodal_rotation.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// z = R A^-1 R^T r with a factor of A and a rotation R per node. Exact for a rigid rotation, accurate where neighbours
/// have similar rotations. O(nodes) in addition to the solve; only the constructor allocates.
class CorotatedSolve {
 public:
  /// With a stiffness, rotations follow the stiffer ones of the parts around a node; see NodalRotations.
  explicit CorotatedSolve(const DeformableBody& body, const BlockMatrix* stiffness = nullptr);

  const EssentialConditions& conditions() const noexcept { return conditions_; }

  /// The rotation of every node under a displacement [m].
  void fit(const VectorX& u, std::vector<Matrix3>& rotation) const noexcept;
  /// Sets the rotations from u [m], for a factor of the body at rest.
  void update(const VectorX& u) noexcept { fit(u, rotation_); }
  /// The same for a factor of the body whose nodes were rotated by `since`.
  void update(const VectorX& u, const std::vector<Matrix3>& since) noexcept;
  /// Sets deformation gradients in place of rotations, for a factor of the body at rest, where they are moderate. They
  /// map displacements without a change of volume to such ones (Piola), so that the solve stays near the inverse for
  /// nearly incompressible tissue that is stretched. For other tissue rotations are nearer.
  void update_stretched(const VectorX& u) noexcept;

  /// Vectors have 3 entries per node; z is zero on constrained dofs.
  void solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept;
  /// y = R A R^T x.
  void apply(const BlockMatrix& a, const VectorX& x, VectorX& y) noexcept;

 private:
  static std::vector<NodeId> all_nodes(std::size_t count);

  EssentialConditions conditions_;
  NodalRotations rotations_;
  std::vector<Matrix3> rotation_;
  VectorX full_, x_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/corotated_solve.ipp>
#endif
