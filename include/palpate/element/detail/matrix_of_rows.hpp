// Tables of reference coordinates and of gradients, written row by row.
#pragma once

#include <palpate/core/config.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The matrix with these rows. Eigen's comma initialiser and blocks would add a second to the compile time of every
/// program that includes an element. No loop, so that the compiler propagates constant entries.
template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> matrix_of_rows(const double (&rows)[Rows][Columns]) noexcept {
  Eigen::Matrix<double, Rows, Columns> m;
  [&]<int... k>(std::integer_sequence<int, k...>) {
    ((m.data()[k] = rows[k % Rows][k / Rows]), ...);
  }
  (std::make_integer_sequence<int, Rows * Columns>());
  return m;
}

}}}  // namespace palpate::detail
