// Tools that press several tissues at the same time.
#pragma once

#include <palpate/haptic/detail/touched_tissue.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One contact problem for all tissues, solved tissue by tissue (block Gauss-Seidel). The compliance of different
/// tissues has no common entries: their contacts have only the couplings of the tools in common. A coupling puts the
/// proxy at x = target + c (f + g), with the forces f of one tissue and g of the others: for that tissue the target is
/// moved by c g (Touch::shift), and rotated by the torques in the same way. Each tissue is solved for the newest forces
/// of the others, until these change by less than the tolerance of a contact problem; one without force follows larger
/// changes only, within the tick. The matrix is symmetric and positive definite, so that this converges. Rotations by
/// the torques of several tissues are added: exact to first order. Blades have no matrix: they are moved one after the
/// other, so that several tissues cut by one render its coupling once. A soft coupling on stiff tissues takes many
/// rounds: the forces on the first tissue are extrapolated (Irons and Tuck 1969). Nothing allocates. A table, so that
/// only programs with a TissueGroup contain the code.
struct SharedTools {
  /// The state of a tool for tissue number `own`: its target moved by the newest forces of the others on it.
  ToolState (*moved)(std::span<TouchedTissue>, std::size_t own, std::size_t tool, const ToolState&) noexcept;
  /// Solves the contact of all tissues, up to a relative change of forces and torques. Where further rounds would
  /// change these by more than 5 % in all, the tissues report solver_not_converged. At most 6 rounds, all but the first
  /// one with at most two linearisations.
  void (*solve)(std::span<TouchedTissue>, double tolerance) noexcept;
};

const SharedTools& shared_tools() noexcept;

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/shared_tools.ipp>
#endif
