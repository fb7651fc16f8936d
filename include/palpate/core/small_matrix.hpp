// Types of vectors, matrices and indices. Arithmetic of small vectors and matrices without Eigen's expressions: same
// notation, values as results, and fewer types for the compiler to instantiate.
#pragma once

#include <palpate/core/config.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Counts and offsets. 64 bits, because (3 x surface nodes)^2 overflows 32 bits from 15 447 nodes on.
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

namespace detail {

template <class M>
concept Small = std::same_as<M, Matrix3> || std::same_as<M, Vector6> || std::same_as<M, Matrix6>;
template <class T, class M>
concept TransposeOf = std::same_as<T, Eigen::Transpose<M>> || std::same_as<T, Eigen::Transpose<const M>>;

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

/// Product of 3 x 3 matrices whose entry (i, j) is data[i * Row + j * Column]: strides 1, 3 for a Matrix3, 3, 1 for its
/// transpose.
template <int RowA, int ColumnA, int RowB, int ColumnB>
Matrix3 product(const double* a, const double* b) noexcept {
  Matrix3 r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      r.data()[3 * j + i] = a[i * RowA] * b[j * ColumnB] + a[i * RowA + ColumnA] * b[RowB + j * ColumnB] +
                            a[i * RowA + 2 * ColumnA] * b[2 * RowB + j * ColumnB];
  return r;
}

}  // namespace detail

// Overload resolution prefers these operators for exactly these types. All other operands use Eigen's expressions.
// Vector3 is written out component by component: g++ then keeps the components in registers.

template <std::same_as<Vector3> V>
PALPATE_ALWAYS_INLINE V operator+(const V& a, const V& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <std::same_as<Vector3> V>
PALPATE_ALWAYS_INLINE V operator-(const V& a, const V& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <std::same_as<Vector3> V>
PALPATE_ALWAYS_INLINE V operator-(const V& a) noexcept {
  return {-a[0], -a[1], -a[2]};
}
template <std::same_as<Vector3> V, std::same_as<double> S>
PALPATE_ALWAYS_INLINE V operator*(const S& s, const V& a) noexcept {
  return {s * a[0], s * a[1], s * a[2]};
}
template <std::same_as<Vector3> V, std::same_as<double> S>
PALPATE_ALWAYS_INLINE V operator*(const V& a, const S& s) noexcept {
  return {a[0] * s, a[1] * s, a[2] * s};
}
template <std::same_as<Vector3> V, std::same_as<double> S>
PALPATE_ALWAYS_INLINE V operator/(const V& a, const S& s) noexcept {
  return {a[0] / s, a[1] / s, a[2] / s};
}

template <detail::Small M>
M operator+(const M& a, const M& b) noexcept {
  M r;
  for (int i = 0; i < M::SizeAtCompileTime; ++i) r.data()[i] = a.data()[i] + b.data()[i];
  return r;
}
template <detail::Small M>
M operator-(const M& a, const M& b) noexcept {
  M r;
  for (int i = 0; i < M::SizeAtCompileTime; ++i) r.data()[i] = a.data()[i] - b.data()[i];
  return r;
}
template <detail::Small M>
M operator-(const M& a) noexcept {
  M r;
  for (int i = 0; i < M::SizeAtCompileTime; ++i) r.data()[i] = -a.data()[i];
  return r;
}
template <detail::Small M, std::same_as<double> S>
M operator*(const S& s, const M& a) noexcept {
  M r;
  for (int i = 0; i < M::SizeAtCompileTime; ++i) r.data()[i] = s * a.data()[i];
  return r;
}
template <detail::Small M, std::same_as<double> S>
M operator*(const M& a, const S& s) noexcept {
  return s * a;
}
template <detail::Small M, std::same_as<double> S>
M operator/(const M& a, const S& s) noexcept {
  M r;
  for (int i = 0; i < M::SizeAtCompileTime; ++i) r.data()[i] = a.data()[i] / s;
  return r;
}

template <std::same_as<Matrix3> M, std::same_as<Vector3> V>
PALPATE_ALWAYS_INLINE V operator*(const M& m, const V& v) noexcept {
  return {m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2], m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
          m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]};
}
template <std::same_as<Matrix3> M>
M operator*(const M& a, const M& b) noexcept {
  return detail::product<1, 3, 1, 3>(a.data(), b.data());
}
template <std::same_as<Matrix6> M, std::same_as<Vector6> V>
V operator*(const M& m, const V& v) noexcept {
  const double *a = m.data(), *x = v.data();
  V r;
  for (int i = 0; i < 6; ++i)
    r.data()[i] =
        a[i] * x[0] + a[6 + i] * x[1] + a[12 + i] * x[2] + a[18 + i] * x[3] + a[24 + i] * x[4] + a[30 + i] * x[5];
  return r;
}
template <detail::TransposeOf<Matrix3> T, std::same_as<Vector3> V>
PALPATE_ALWAYS_INLINE V operator*(const T& t, const V& v) noexcept {
  const double* m = t.nestedExpression().data();
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}
template <detail::TransposeOf<Matrix3> T, std::same_as<Matrix3> M>
M operator*(const T& t, const M& b) noexcept {
  return detail::product<3, 1, 1, 3>(t.nestedExpression().data(), b.data());
}
template <std::same_as<Matrix3> M, detail::TransposeOf<Matrix3> T>
M operator*(const M& a, const T& t) noexcept {
  return detail::product<1, 3, 3, 1>(a.data(), t.nestedExpression().data());
}
template <std::same_as<Vector3> V, detail::TransposeOf<Vector3> T>
Matrix3 operator*(const V& a, const T& t) noexcept {
  const double* b = t.nestedExpression().data();
  Matrix3 r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) r.data()[3 * j + i] = a.data()[i] * b[j];
  return r;
}

inline Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// The largest magnitude of a component. All components must be finite.
inline double max_abs(const Vector3& v) noexcept {
  return std::max(std::abs(v[0]), std::max(std::abs(v[1]), std::abs(v[2])));
}

/// By cofactors.
inline double determinant(const Matrix3& m) noexcept {
  return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
         m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}
/// By cofactors; entries are not finite when m is singular.
inline Matrix3 inverse(const Matrix3& m) noexcept {
  const double scale = 1.0 / determinant(m);
  Matrix3 r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      r(i, j) = scale * (m(a, c) * m(b, d) - m(a, d) * m(b, c));
    }
  return r;
}

/// The three entries of a node in a vector with three entries per node.
inline Vector3 node_vector(const VectorX& all, Index node) noexcept {
  return {all[3 * node], all[3 * node + 1], all[3 * node + 2]};
}
inline void set_node_vector(VectorX& all, Index node, const Vector3& v) noexcept {
  for (int c = 0; c < 3; ++c) all[3 * node + c] = v[c];
}
inline void add_node_vector(VectorX& all, Index node, const Vector3& v) noexcept {
  for (int c = 0; c < 3; ++c) all[3 * node + c] += v[c];
}

/// No component is NaN or infinite.
inline bool all_finite(const double* x, Index n) noexcept {
  double sum = 0.0;  // x - x is NaN for NaN and infinity
  for (Index i = 0; i < n; ++i) sum += x[i] - x[i];
  return sum == 0.0;
}
template <class M>
bool all_finite(const Eigen::PlainObjectBase<M>& m) noexcept {
  return all_finite(m.data(), m.size());
}

}}  // namespace palpate
