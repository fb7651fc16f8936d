// Unit loads on a few dofs after the forward substitution of a multifrontal factor.
#pragma once

#include <palpate/core/types.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The non-zero rows of L^-1 e for unit loads e on some dofs of an interior factor, and the loads to which they
/// condense on the kept dofs. These give entries of the inverse without a backward substitution: with F the condensed
/// loads and C the compliance of the kept dofs, G_ij = y_i . y_j + f_i . C f_j.
struct ReducedUnits {
  std::vector<Index> places;  ///< of the rows, in the elimination order, ascending
  MatrixX values;             ///< places x loads
  MatrixX kept_load;          ///< kept x loads

  Index size() const noexcept { return values.cols(); }
  /// y_i . y_j for all pairs.
  MatrixX products(const ReducedUnits& other) const;
};

struct FrontTree;

/// Forward substitution of unit loads on `dofs`, none of them kept, through the first `fronts` fronts; `kept` are the
/// dofs of the front after them. Visits only the fronts above the dofs. Allocates.
ReducedUnits reduce_units(const FrontTree& tree, const double* factor, Index fronts, std::span<const Index> dofs,
                          std::span<const Index> kept);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/front_reduction.ipp>
#endif
