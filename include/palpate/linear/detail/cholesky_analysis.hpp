// The part of a sparse Cholesky factorisation that depends only on the pattern of the matrix.
#pragma once

#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/node_graph.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

struct FrontTree;

/// Elimination order, fronts and memory of a factorisation, for any values on one pattern. Copies share all data.
class CholeskyAnalysis {
 public:
  CholeskyAnalysis() = default;

  /// Analyses the pattern of the lower half of a matrix. O(nonzeros + nodes log nodes), a few per cent of the
  /// factorisation. Throws bad_argument when the layout does not fit the matrix, or cancelled.
  explicit CholeskyAnalysis(const SparseLower& lower, const DofLayout& layout = {}, const SetupLimits& limits = {});

  Index size() const noexcept;
  /// Dofs eliminated last, as given in the layout.
  const std::vector<Index>& kept() const noexcept;
  /// The node of each dof, as given in the layout; may be empty.
  const std::vector<Index>& node_of_dof() const noexcept;
  Index front_count() const noexcept;
  /// Stored entries of L, including zeros from merged fronts.
  double nonzeros() const noexcept;
  /// Multiplications and additions of a factorisation: sum of squares of the column lengths of L.
  double flops() const noexcept;
  /// Memory of a finished factor [bytes].
  double factor_bytes() const noexcept;
  /// Peak memory of a factorisation, including the factor [bytes]. Allocates: O(fronts).
  double peak_bytes(int threads = 1) const;
  /// Peak memory when the last front is returned as a Schur complement, including that [bytes]. Allocates: O(fronts).
  double interior_peak_bytes(int threads = 1) const;
  /// Peak memory of a RepeatedCholesky [bytes].
  double repeated_peak_bytes() const noexcept;
  /// True when the matrix has the pattern that was analysed.
  bool fits(const SparseLower& lower) const noexcept;

  /// Hash of the elimination order and of the memory layout of a factor: a stored factor belongs to an analysis with
  /// the same hash. The order depends on floating-point positions, so it may differ between builds.
  std::uint64_t order_hash() const noexcept;

  const FrontTree& tree() const noexcept;
  /// Doubles that a factorisation needs to pack operands, including zero rows at the end.
  Index pack_size() const noexcept;

 private:
  struct Data;

  std::shared_ptr<const Data> data_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/cholesky_analysis.ipp>
#endif
