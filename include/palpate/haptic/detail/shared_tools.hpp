// Tools that press several tissues at the same time.
#pragma once

#include <palpate/haptic/detail/touched_tissue.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One contact problem for all tissues, solved tissue by tissue (block Gauss-Seidel). The compliance of different
/// tissues has no common entries: their contacts have only the couplings of the tools in common. A coupling puts the
/// proxy at x = target + c (f + g), with the forces f of one tissue and g of the others: for that tissue the target is
/// moved by c g (Touch::shift), and rotated by the torques in the same way. Each tissue is solved for the newest forces
/// of the others, until these change by less than the tolerance of a contact problem. The matrix is symmetric and
/// positive definite, so that this converges. A soft coupling on stiff tissues takes many rounds: the forces on the
/// first tissue are extrapolated (Irons and Tuck 1969). Nothing allocates. A table, so that only programs with a
/// TissueGroup contain the code.
struct SharedTools {
  /// Moves the targets by the forces of the last tick. Before the states of a tick are received.
  void (*begin_tick)(std::span<TouchedTissue>) noexcept;
  /// A state for a tissue: with the target moved.
  ToolState (*moved)(const ToolState&, const Touch&) noexcept;
  /// Solves the contact of all tissues, up to a relative change of the forces. Where these would change by more than 5
  /// % in another round, the tissues report solver_not_converged.
  void (*solve)(std::span<TouchedTissue>, double tolerance) noexcept;
};

const SharedTools& shared_tools() noexcept;

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/shared_tools.ipp>
#endif
