// Tables of reference coordinates and of gradients, written row by row.
#pragma once

#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The matrix with these rows. Eigen's comma initialiser and blocks would cost every program that includes an element
/// a second of compilation.
template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> matrix_of_rows(const double (&rows)[Rows][Columns]) noexcept {
  Eigen::Matrix<double, Rows, Columns> m;
  for (int j = 0; j < Columns; ++j)
    for (int i = 0; i < Rows; ++i) m.data()[Rows * j + i] = rows[i][j];
  return m;
}

}}}  // namespace palpate::detail
