// Reads and writes square matrices in a binary file.
#pragma once

#include <palpate/core/detail/binary_io.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Writes all entries by columns; a null pointer is written as an empty matrix.
template <class Matrix>
void write_dense(BinaryWriter& out, const Matrix* matrix) {
  using Scalar = typename Matrix::Scalar;
  if (matrix == nullptr) return out.array(std::span<const Scalar>());
  out.array(std::span<const Scalar>(matrix->data(), static_cast<std::size_t>(matrix->size())));
}

/// Reads a matrix that must be size x size in the file. Throws too_large before it allocates.
template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> read_dense(BinaryReader& in, Index size,
                                                                 const SetupLimits& limits) {
  limits.require_memory(static_cast<double>(size) * static_cast<double>(size) * sizeof(Scalar), "a stored matrix");
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> matrix;
  if (!in.good()) return matrix;
  matrix.resize(size, size);
  in.array(std::span<Scalar>(matrix.data(), static_cast<std::size_t>(matrix.size())));
  return matrix;
}

}}}  // namespace palpate::detail
