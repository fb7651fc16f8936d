// Fixed-size vectors, matrices and index types used everywhere, and their arithmetic.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>

#include <concepts>
#include <limits>
#include <type_traits>

namespace palpate { inline namespace PALPATE_ABI {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

// clang-format off
/// True for an Eigen matrix type of exactly R x C doubles. `convertible_to<Matrix6>` would also accept a 5 x 5.
template <class M, int R, int C>
concept FixedMatrix = requires {
  requires std::derived_from<std::remove_cvref_t<M>, Eigen::PlainObjectBase<std::remove_cvref_t<M>>>;  // no expressions
  requires std::remove_cvref_t<M>::RowsAtCompileTime == R;
  requires std::remove_cvref_t<M>::ColsAtCompileTime == C;
  requires std::same_as<typename std::remove_cvref_t<M>::Scalar, double>;
};

/// As FixedMatrix, or an Eigen expression of that shape, which is read in place without a copy.
template <class M, int R, int C>
concept FixedExpression = requires {
  requires std::derived_from<std::remove_cvref_t<M>, Eigen::MatrixBase<std::remove_cvref_t<M>>>;
  requires std::remove_cvref_t<M>::RowsAtCompileTime == R;
  requires std::remove_cvref_t<M>::ColsAtCompileTime == C;
  requires std::same_as<typename std::remove_cvref_t<M>::Scalar, double>;
};

// clang-format on

template <class V, int N>
concept FixedVector = FixedMatrix<V, N, 1>;

}}  // namespace palpate
