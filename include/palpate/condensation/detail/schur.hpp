// Exact static condensation (thesis 3.7, eqs. 3.49-3.51; Bro-Nielsen and Cotin 1996).
#pragma once

#include <palpate/linear/sparse_cholesky.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// K split into kept and condensed dofs. With P_f = -K_kc K_cc^-1 the condensed system is P_u u_k = f_k + P_f f_c,
/// where P_u = K_kk - K_kc K_cc^-1 K_ck. The thesis drops P_f f_c; here loads on condensed dofs are included. The kept
/// dofs are eliminated last, so P_u is the last front of one factorisation and nothing else is computed or stored.
struct SchurComplement {
  MatrixX stiffness;        ///< P_u, kept x kept [N/m]
  SparseCholesky interior;  ///< condenses loads and recovers condensed dofs
};

/// Condenses the matrix whose lower half is given onto `layout.kept` (in that order). Cost: one factorisation. Throws
/// not_positive_definite, too_large or cancelled.
SchurComplement condense(const SparseLower& lower, const DofLayout& layout, const SetupLimits& limits);
/// The same without nodes and positions.
SchurComplement condense(const SparseLower& lower, std::vector<Index> kept, const SetupLimits& limits);

inline SchurComplement condense(const SparseLower& lower, const DofLayout& layout, const SetupLimits& limits) {
  SchurComplement s;
  s.interior = SparseCholesky::interior(CholeskyAnalysis(lower, layout, limits), lower, s.stiffness, limits);
  return s;
}
inline SchurComplement condense(const SparseLower& lower, std::vector<Index> kept, const SetupLimits& limits) {
  return condense(lower, DofLayout{{}, {}, std::move(kept)}, limits);
}

}}}  // namespace palpate::detail
