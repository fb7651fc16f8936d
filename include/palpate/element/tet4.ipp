// Definitions of tet4.hpp.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(Element<Tet4>);

PALPATE_INLINE Eigen::Vector4d Tet4::shape(const Vector3& xi) noexcept {
  return {1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
}

PALPATE_INLINE Eigen::Matrix<double, 4, 3> Tet4::gradient(const Vector3&) noexcept {
  return detail::matrix_of_rows<4, 3>({{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
}

PALPATE_INLINE Eigen::Matrix<double, 4, 3> Tet4::reference_nodes() noexcept {
  return detail::matrix_of_rows<4, 3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
}

}}  // namespace palpate
