// The linear part of a body around a part at large strain, condensed onto the nodes between them.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/model/moving/detail/body_parts.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A linear body at rest under its loads, as a stiffness and forces on its interface: exact static condensation.
/// Vectors have 3 entries per node of the part. Only the constructor allocates or throws.
class LinearSurroundings {
 public:
  /// Throws not_positive_definite, too_large or cancelled.
  LinearSurroundings(BlockMatrix stiffness, EssentialConditions conditions, const std::vector<Vector3>& positions,
                     const std::vector<NodeId>& interface, const SetupLimits& limits);

  bool is_interface(std::size_t node) const noexcept { return is_interface_[node] != 0; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  /// Free dofs of the interface, ascending.
  const std::vector<Index>& kept() const noexcept { return kept_; }
  /// Their stiffness, kept x kept [N/m].
  const MatrixX& stiffness() const noexcept { return schur_; }

  /// Sets loads [N], or prescribed values [m]; one solve when they have changed. Loads on interface nodes and values of
  /// free dofs are ignored. Returns whether there was a change.
  bool set_load(const VectorX& load) noexcept;
  bool set_prescribed(const VectorX& values) noexcept;

  /// Displacement while the kept dofs do not move [m], and force on these dofs [N].
  struct Still {
    VectorX displacement, kept_load;
  };
  const Still& from_load() const noexcept { return from_load_; }
  const Still& from_prescribed() const noexcept { return from_prescribed_; }
  /// Their sum on kept dof i [N].
  double kept_load(Index i) const noexcept { return from_load_.kept_load[i] + from_prescribed_.kept_load[i]; }
  /// Displacement u of the free dofs for a displacement of the kept dofs, without loads. Half a solve. May run in
  /// another thread than the other functions.
  void extend(const VectorX& kept, VectorX& u) noexcept;

 private:
  /// Solves for `full_` with the kept dofs fixed; prescribed components are not set.
  void solve(Still& still) noexcept;

  BlockMatrix stiffness_;
  EssentialConditions conditions_;
  std::vector<std::uint8_t> is_interface_;  // per node
  std::vector<Index> kept_;
  SparseCholesky interior_;
  MatrixX schur_;
  SparseCholesky extension_;  // shares the factor, with its own workspace
  VectorX load_, full_, free_;
  Still from_load_, from_prescribed_;
  VectorX zeros_;     // of the kept dofs
  VectorX extended_;  // free dofs
};

/// Energy and force of a part at large strain and of its linear surroundings, at a displacement of the part. Refers to
/// the surroundings' stiffness, which must outlive it.
class SurroundedForces final : public EnergyForces {
 public:
  /// `kept`: dofs of the part, in the order of the stiffness.
  SurroundedForces(std::unique_ptr<EnergyForces> part, const MatrixX& stiffness, std::vector<Index> kept)
      : part_(std::move(part)),
        stiffness_(stiffness),
        kept_(std::move(kept)),
        moved_(stiffness.rows()),
        pulled_(stiffness.rows()) {}
  Index size() const noexcept override { return part_->size(); }
  double evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept override;
  double rounding() const noexcept override { return part_->rounding(); }
  double evaluate_rotated(const std::vector<Vector3>& positions, VectorX& u, VectorX& f) noexcept override {
    return part_->evaluate_rotated(positions, u, f);
  }

 private:
  std::unique_ptr<EnergyForces> part_;
  const MatrixX& stiffness_;
  std::vector<Index> kept_;
  VectorX moved_, pulled_;
};

/// Dofs of `part` for dofs of `other`, both parts of one mesh.
std::vector<Index> dofs_in(const BodyPart& part, const BodyPart& other, const std::vector<Index>& dofs);

/// The stiffness of a part and of its surroundings, on the pattern that both need.
class SurroundedStiffness {
 public:
  /// `dense` is the stiffness of the surroundings on these dofs of the part, ascending. Throws too_large.
  SurroundedStiffness(const BlockPattern& part, const MatrixX& dense, const std::vector<Index>& dofs,
                      const SetupLimits& limits);

  const BlockPattern& pattern() const noexcept { return surroundings_.pattern(); }
  /// Sets `sum`, a matrix on `pattern`. No allocation.
  void add_up(const BlockMatrix& part, BlockMatrix& sum) const noexcept;

 private:
  BlockMatrix surroundings_;
  std::vector<Index> position_;  // of every block of the part
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/linear_surroundings.ipp>
#endif
