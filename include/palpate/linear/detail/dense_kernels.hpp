// Products of dense matrices, compiled once for all shapes of operands.
#pragma once

#include <palpate/core/executor.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/detail/kernel_types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

using any_flags::Operand;
using any_flags::Read;
using any_flags::Target;

/// c = c + factor a b, where a has `depth` columns. The operands must not overlap c; only one of them, and not that of
/// a lower half, may be symmetric. Allocates its packed copies. A large product is divided among the threads; the
/// result has the same bits.
void add_product(const Target& c, double factor, const Operand& a, const Operand& b, Index depth,
                 const SetupThreads& threads = 1);

/// a b and a^T b.
MatrixX product(const MatrixX& a, const MatrixX& b);
MatrixX transposed_product(const MatrixX& a, const MatrixX& b);

/// y = y - a x and y = a^T x, a stored by columns. No allocation.
void subtract_product(const double* a, Index rows, Index columns, const double* x, double* y) noexcept;
void transposed_product(const double* a, Index rows, Index columns, const double* x, double* y) noexcept;
/// y = a x for a symmetric matrix; reads the lower half once. No allocation.
void symmetric_product(const MatrixX& a, const double* x, double* y) noexcept;

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/dense_kernels.ipp>
#endif
