// A factor of the matrix of a step, rotated with the nodes and renewed in a thread.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/detail/corotated_solve.hpp>
#include <palpate/model/moving/detail/renewal_thread.hpp>
#include <palpate/model/moving/detail/step_factor.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Sets a matrix to the stiffness of a body at a displacement, approximately. Returns false where it has none: inverted
/// elements. Allocates.
using StiffnessAt = std::function<bool(const VectorX& u, BlockMatrix& k)>;

/// z = R A^-1 R^T r with a factor of A = K + m M, read in single precision, and a rotation per node. K is the stiffness
/// at rest, or at a recent shape s when a thread renews it; R are the rotations since that shape. Only the constructor,
/// and the thread, allocate. Neither copyable nor movable.
class RenewableFactor final : public StepFactor {
 public:
  /// The nodes `last` are eliminated last. Without `stiffness_at`, on the pattern of `stiffness`, nothing is renewed
  /// and there is no thread. Throws too_large.
  RenewableFactor(const DeformableBody& body, BlockMatrix stiffness, const std::vector<NodeId>& last,
                  StiffnessAt stiffness_at, const SetupLimits& limits);

  /// Factorises at rest.
  bool set_mass(double mass) noexcept override;
  void rotate(const VectorX& u, bool stretched = false) noexcept override;
  /// z is zero on constrained dofs.
  void solve(const VectorX& r, VectorX& z) noexcept override { corotated_.solve(*front().factor, r, z); }
  void apply(const VectorX& x, VectorX& y) noexcept override { corotated_.apply(front().factor->matrix(), x, y); }
  bool is_uneven() const noexcept override { return is_uneven_; }
  void ask(const VectorX& u) noexcept override;
  void take_renewed() noexcept override;
  long renewals() const noexcept override { return renewals_; }

  /// Number of nodes.
  Index nodes() const noexcept { return lumped_.size(); }
  /// The diagonal block of the matrix at rest, for a node.
  Matrix3 diagonal(NodeId node) const noexcept;

 private:
  /// A factor and the shape that it was made for.
  struct Shape {
    std::unique_ptr<TangentSolver> factor;
    std::vector<Matrix3> rotation;  // of the nodes
    double mass = 0.0;
    bool usable = false, is_at_rest = false;
  };
  Shape& front() noexcept { return shapes_[front_]; }
  Shape& spare() noexcept { return shapes_[1 - front_]; }
  Shape make_shape(const DeformableBody& body, const std::vector<NodeId>& last, const SetupLimits& limits) const;
  /// Ratio of the largest and the smallest modulus around a node, as far as the diagonal shows it.
  double contrast() const noexcept;
  static constexpr double uneven_contrast = 100.0;
  // In the thread
  void renew() noexcept;
  bool find_stiffness(BlockMatrix& k) noexcept;

  VectorX lumped_;         // mass per node [kg]
  BlockMatrix stiffness_;  // at rest
  bool is_uneven_;
  CorotatedSolve corotated_;
  std::array<Shape, 2> shapes_;
  std::size_t front_ = 0;
  StiffnessAt stiffness_at_;
  VectorX asked_;  // displacement; used by the thread while it works
  long renewals_ = 0;
  std::optional<RenewalThread> thread_;  // last: it uses all other members
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/renewable_factor.ipp>
#endif
