// Definitions of dense_inverse.hpp.
#pragma once

#include <palpate/core/binary_io.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>
#include <palpate/linear/detail/spd_inverse.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<DenseInverse<float>>);

namespace detail {

/// x += columns of an n x n matrix times their loads. A plain loop, which compilers vectorise.
template <int N, class Scalar>
void add_loaded_columns(const Scalar* matrix, Index n, const Index* columns, const double* b, double* x) noexcept {
  const Scalar* column[N];
  double load[N];
  for (int k = 0; k < N; ++k) {
    column[k] = matrix + columns[k] * n;
    load[k] = b[columns[k]];
  }
  for (Index i = 0; i < n; ++i) {
    double sum = x[i];
    for (int k = 0; k < N; ++k) sum += load[k] * static_cast<double>(column[k][i]);
    x[i] = sum;
  }
}

/// The same for as many columns as are done in one pass. In single precision by a kernel for the processor.
inline void add_pass(const double* matrix, Index n, const Index* columns, const double* b, double* x) noexcept {
  add_loaded_columns<any_flags::columns_at_once>(matrix, n, columns, b, x);
}
inline void add_pass(const float* matrix, Index n, const Index* columns, const double* b, double* x) noexcept {
  const float* column[any_flags::columns_at_once];
  double load[any_flags::columns_at_once];
  for (int k = 0; k < any_flags::columns_at_once; ++k) {
    column[k] = matrix + columns[k] * n;
    load[k] = b[columns[k]];
  }
  processor_kernels().add_float_columns(column, load, n, x);
}

}  // namespace detail

template <std::floating_point Scalar>
DenseInverse<Scalar>::DenseInverse(MatrixX matrix, const SetupLimits& limits) {
  detail::SpdInverse::invert(matrix, 1e-15, "the condensed stiffness is not positive definite", limits.threads);
  if constexpr (std::same_as<Scalar, double>) {
    inverse_ = std::make_shared<const Matrix>(std::move(matrix));
  } else {
    Matrix rounded(matrix.rows(), matrix.cols());
    for (Index i = 0; i < matrix.size(); ++i) rounded.data()[i] = static_cast<Scalar>(matrix.data()[i]);
    inverse_ = std::make_shared<const Matrix>(std::move(rounded));
  }
}

template <std::floating_point Scalar>
void DenseInverse<Scalar>::write(BinaryWriter& out) const {
  detail::write_dense(out, inverse_.get());
}

template <std::floating_point Scalar>
DenseInverse<Scalar> DenseInverse<Scalar>::read(BinaryReader& in, Index size, const SetupLimits& limits) {
  DenseInverse read;
  read.inverse_ = std::make_shared<const Matrix>(detail::read_dense<Scalar>(in, size, limits));
  return read;
}

template <std::floating_point Scalar>
SolveReport DenseInverse<Scalar>::solve_into(const VectorX& b, VectorX& x) noexcept {
  constexpr int most = any_flags::columns_at_once;
  const Scalar* const matrix = inverse_ ? inverse_->data() : nullptr;
  const Index n = size();
  std::fill_n(x.data(), x.size(), 0.0);
  Index loaded[most];
  int count = 0;
  for (Index j = 0; j < n; ++j) {
    if (b.data()[j] == 0.0) continue;
    loaded[count++] = j;
    if (count < most) continue;
    detail::add_pass(matrix, n, loaded, b.data(), x.data());
    count = 0;
  }
  for (int k = 0; k < count; ++k) detail::add_loaded_columns<1>(matrix, n, loaded + k, b.data(), x.data());
  return {true, 0, std::numeric_limits<double>::quiet_NaN()};
}

#if !PALPATE_HEADER_ONLY
template class DenseInverse<double>;
template class DenseInverse<float>;
#endif

}}  // namespace palpate
