// Eigenvalues and eigenvectors of a small dense symmetric matrix.
#pragma once

#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Replaces a symmetric matrix (lower half read) by its orthonormal eigenvectors, one per column, and writes the
/// eigenvalues in ascending order. Householder reflections to tridiagonal form and implicit QL steps (Bowdler, Martin,
/// Reinsch and Wilkinson 1968; EISPACK tred2 and tql2). About 9 n^3 multiplications. The entries must be finite.
void symmetric_eigen(MatrixX& matrix, VectorX& values);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/symmetric_eigen.ipp>
#endif
