// Definitions of tri3.hpp.
#pragma once

#include <palpate/element/tri3.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TriangulatedFace<Tri3>);

PALPATE_INLINE Eigen::Matrix<double, 3, 2> Tri3::gradient(const Eigen::Vector2d&) noexcept {
  return detail::matrix_of_rows<3, 2>({{-1, -1}, {1, 0}, {0, 1}});
}

PALPATE_INLINE Eigen::Matrix<double, 3, 2> Tri3::reference_nodes() noexcept {
  return detail::matrix_of_rows<3, 2>({{0, 0}, {1, 0}, {0, 1}});
}

}}  // namespace palpate
