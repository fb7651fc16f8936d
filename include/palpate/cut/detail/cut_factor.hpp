// A factor of a body that is used after cuts, until a thread has computed that of the cut body.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/model/moving/detail/renewable_factor.hpp>
#include <palpate/model/moving/detail/renewal_thread.hpp>
#include <palpate/model/moving/detail/step_factor.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A body after cuts, for its factor.
struct CutBody {
  DeformableBody body;                     ///< conditions, positions, lumped mass and pattern
  std::function<BlockMatrix()> stiffness;  ///< at rest; called by the thread
  VectorX nodal_mass;               ///< [kg]; the lumped mass has another distribution in elements of second order
  std::vector<NodeId> copied_from;  ///< node from which a node was split, which has a smaller id; or itself
};

/// The factor A of an earlier body, extended to the nodes that cuts have copied since: S A^-1 S^T + D. S gives a copy
/// the displacement of the node that it was split from; D is the inverse of the diagonal block of A on nodes with
/// copies, for their relative displacement. A thread computes the factor of the newest body. `follow` and, once after
/// it, `take_renewed` allocate.
class CutFactor final : public StepFactor {
 public:
  /// `base` is the factor of the body before any cut.
  explicit CutFactor(std::shared_ptr<RenewableFactor> base);

  /// Continues on the body after a cut, whose nodes are those of the last one and new copies.
  void follow(std::shared_ptr<const CutBody> body);
  /// Returns to the body before any cut.
  void restart();

  bool set_mass(double mass) noexcept override;
  void rotate(const VectorX& u, bool stretched = false) noexcept override;
  void solve(const VectorX& r, VectorX& z) noexcept override;
  /// Without the copies.
  void apply(const VectorX& x, VectorX& y) noexcept override;
  bool is_uneven() const noexcept override { return base_->is_uneven(); }
  void take_renewed() noexcept override;
  long renewals() const noexcept override { return renewals_; }

 private:
  void request();
  /// Finds the node of the base of every node, and D.
  void find_base_nodes();
  // In the thread
  void compute() noexcept;
  std::shared_ptr<RenewableFactor> make() const;

  std::shared_ptr<RenewableFactor> base_, whole_;  // the latter: before any cut
  double mass_ = 0.0;
  std::shared_ptr<const CutBody> newest_;  // null: before any cut
  /// What the thread is asked for, and its result; used by the thread while it works.
  struct Request {
    std::shared_ptr<const CutBody> body;
    double mass = 0.0;
    bool wanted = false;  // false after a restart; not used by the thread
    std::shared_ptr<RenewableFactor> made;
  };
  Request request_;
  std::vector<NodeId> base_node_;
  std::vector<NodeId> split_;      // nodes with a copy, and copies
  std::vector<Matrix3> relative_;  // D, for each
  VectorX base_r_, base_z_;
  long renewals_ = 0;
  RenewalThread thread_;  // last: it uses all other members
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/cut_factor.ipp>
#endif
