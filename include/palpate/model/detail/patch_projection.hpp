// Solves for what one patch of a mesh makes of the field of a half-space.
#pragma once

#include <palpate/model/detail/half_space_load.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The blocks below the diagonal of a BlockMatrix, found by column: with them a whole row can be read. 12 bytes per
/// block.
class ColumnBlocks {
 public:
  struct Block {
    NodeId row;
    Index position;
  };
  explicit ColumnBlocks(const BlockPattern& pattern);
  std::span<const Block> of(NodeId column) const noexcept {
    const auto i = static_cast<std::size_t>(column);
    return {block_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
  }

 private:
  std::vector<Index> first_;
  std::vector<Block> block_;
};

namespace detail {

/// Whether the components that are prescribed, a bit each, have more than half of the normal.
inline bool is_fixed_along(const Vector3& normal, std::uint8_t components) noexcept {
  double part = 0.0;
  for (int c = 0; c < 3; ++c)
    if ((components >> c & 1) != 0) part += normal[c] * normal[c];
  return part > 0.5;
}

}  // namespace detail

/// The compliance of a touched vertex to the force on the vertex in the middle of a patch.
struct PatchEntry {
  int vertex;
  Matrix3 compliance;  ///< times the shear modulus [1/m]
};

/// Worker of one thread. K_ff g = load - K_fb G_b, where f are the free nodes of a patch, b all other nodes that the
/// stiffness couples to them, G_b the field of the half-space there.
class PatchProjection {
 public:
  /// Keeps references.
  PatchProjection(const HalfSpaceSource& source, const ColumnBlocks& columns);

  /// Fills `entries` with the touched vertices among the free nodes, by vertex, and sets marks. Leaves it empty
  /// above a support that is too near, and when there is no solution: a pivot that is not positive, or a residual above
  /// 1e-8.
  void solve(int vertex, const Vector3& normal, std::vector<PatchEntry>& entries, HalfSpaceMarks& marks);

 private:
  void assemble(const UniformStiffness& stiffness, const HalfSpaceField& field);
  void release_cut_domains(const UniformStiffness& stiffness, const HalfSpaceField& field);
  void release(int domain, double bulk, const Vector3& mean_stress, const HalfSpaceField& field);
  double support_below(NodeId middle, const Vector3& normal) const noexcept;
  bool solve_dense();
  const Matrix3& boundary_value(NodeId node, const HalfSpaceField& field);

  const HalfSpaceSource& source_;
  const ColumnBlocks& columns_;
  NodePatch patch_;
  HalfSpaceLoad load_;
  MatrixX matrix_, right_, solution_;
  VectorX b_, x_;
  std::vector<int> known_;  // per node, the patch for which its boundary value is known, and where that is
  std::vector<int> value_of_;
  std::vector<Matrix3> values_;
  int number_ = 0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/patch_projection.ipp>
#endif
