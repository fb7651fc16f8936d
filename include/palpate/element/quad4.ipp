// Definitions of quad4.hpp.
#pragma once

#include <palpate/element/quad4.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TriangulatedFace<Quad4>);

PALPATE_INLINE Eigen::Vector4d Quad4::shape(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  return {0.25 * ((1 - u) * (1 - v)), 0.25 * ((1 + u) * (1 - v)), 0.25 * ((1 + u) * (1 + v)),
          0.25 * ((1 - u) * (1 + v))};
}

PALPATE_INLINE Eigen::Matrix<double, 4, 2> Quad4::gradient(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  return detail::matrix_of_rows<4, 2>({{0.25 * (v - 1), 0.25 * (u - 1)},
                                       {0.25 * (1 - v), 0.25 * (-1 - u)},
                                       {0.25 * (1 + v), 0.25 * (1 + u)},
                                       {0.25 * (-1 - v), 0.25 * (1 - u)}});
}

PALPATE_INLINE Eigen::Matrix<double, 4, 2> Quad4::reference_nodes() noexcept {
  return detail::matrix_of_rows<4, 2>({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
}

}}  // namespace palpate
