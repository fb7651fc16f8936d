// Exact static condensation (thesis 3.7, eqs. 3.49-3.51; Bro-Nielsen and Cotin 1996).
#pragma once

#include <palpate/linear/sparse_cholesky.hpp>

#include <span>

namespace palpate::inline PALPATE_ABI {

/// K split into kept and condensed dofs. With P_f = -K_kc K_cc^-1 the condensed system is P_u u_k = f_k + P_f f_c,
/// where P_u = K_kk - K_kc K_cc^-1 K_ck. The thesis drops P_f f_c; here loads on condensed dofs count.
struct SchurComplement {
  using Matrix = SparseCholesky::Matrix;
  MatrixX stiffness;             ///< P_u, kept x kept [N/m]
  Matrix coupling;               ///< K_ck, condensed x kept
  SparseCholesky interior;       ///< factor of K_cc
  std::vector<Index> kept;       ///< indices in the given matrix
  std::vector<Index> condensed;  ///< the others, ascending
};

/// Condenses the matrix whose lower half is given onto `kept` (in that order). Cost: one factorisation of the condensed
/// part and one solve per kept dof. Throws not_positive_definite, too_large or cancelled.
inline SchurComplement condense(const SchurComplement::Matrix& lower, std::span<const Index> kept,
                                const SetupLimits& limits) {
  using Triplet = Eigen::Triplet<double, Index>;
  const Index n = lower.rows(), k = static_cast<Index>(kept.size());
  limits.require_memory(3.0 * static_cast<double>(k) * static_cast<double>(k) * sizeof(double),
                        "the condensed stiffness");

  SchurComplement s;
  s.kept.assign(kept.begin(), kept.end());
  std::vector<Index> position(static_cast<std::size_t>(n), -1);  // kept: -2 - index, condensed: index
  for (Index i = 0; i < k; ++i) position[static_cast<std::size_t>(kept[static_cast<std::size_t>(i)])] = -2 - i;
  for (Index i = 0; i < n; ++i)
    if (position[static_cast<std::size_t>(i)] == -1) {
      position[static_cast<std::size_t>(i)] = static_cast<Index>(s.condensed.size());
      s.condensed.push_back(i);
    }
  std::vector<Triplet> inner, coupling;
  s.stiffness = MatrixX::Zero(k, k);
  for (Index col = 0; col < n; ++col)
    for (SchurComplement::Matrix::InnerIterator it(lower, col); it; ++it) {
      const Index p = position[static_cast<std::size_t>(it.row())], q = position[static_cast<std::size_t>(col)];
      if (p >= 0 && q >= 0)
        inner.emplace_back(std::max(p, q), std::min(p, q), it.value());
      else if (p >= 0)
        coupling.emplace_back(p, -2 - q, it.value());
      else if (q >= 0)
        coupling.emplace_back(q, -2 - p, it.value());
      else
        s.stiffness(-2 - p, -2 - q) = s.stiffness(-2 - q, -2 - p) = it.value();
    }
  const Index m = static_cast<Index>(s.condensed.size());
  SchurComplement::Matrix k_cc(m, m);
  k_cc.setFromTriplets(inner.begin(), inner.end());
  s.coupling.resize(m, k);
  s.coupling.setFromTriplets(coupling.begin(), coupling.end());
  s.interior = SparseCholesky(k_cc, limits);
  constexpr Index width = 48;
  for (Index begin = 0; begin < k && m > 0; begin += width) {
    limits.advance("condensation", static_cast<double>(begin) / static_cast<double>(k));
    const Index count = std::min(width, k - begin);
    const MatrixX response = s.interior.solve(MatrixX(s.coupling.middleCols(begin, count)));
    s.stiffness.middleCols(begin, count).noalias() -= s.coupling.transpose() * response;
  }
  s.stiffness = (0.5 * (s.stiffness + s.stiffness.transpose())).eval();
  return s;
}

}  // namespace palpate::inline PALPATE_ABI
