// Fixed-size vectors, matrices and index types used everywhere.
#pragma once

#include <palpate/core/config.hpp>

#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace palpate { inline namespace PALPATE_ABI {

/// Counts and offsets. 64 bit: (3 x surface nodes)^2 overflows 32 bits from 15 447 nodes on.
using Index = std::int64_t;
/// A node of a mesh, as stored in connectivity.
using NodeId = std::int32_t;

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
/// Stress or strain in Voigt order (core/voigt.hpp).
using Vector6 = Eigen::Matrix<double, 6, 1>;
/// Elasticity matrix in Voigt order.
using Matrix6 = Eigen::Matrix<double, 6, 6>;
/// Derivative of one 3 x 3 tensor by another, both in column-major order (core/tensor3.hpp).
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

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

/// As FixedMatrix, or an Eigen expression of that shape: one that is read where it lies, without a copy.
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

// Their arithmetic, wherever they are used.
#include <palpate/core/small_matrix.hpp>
