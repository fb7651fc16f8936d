// Definitions of hex8.hpp.
#pragma once

#include <palpate/element/detail/matrix_of_rows.hpp>
#include <palpate/element/hex8.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(Element<Hex8>);

PALPATE_INLINE Eigen::Matrix<double, 8, 1> Hex8::shape(const Vector3& xi) noexcept {
  const Eigen::Vector4d n = Quad4::shape({xi[0], xi[1]});
  const double bottom = 0.5 * (1.0 - xi[2]), top = 0.5 * (1.0 + xi[2]);
  Eigen::Matrix<double, 8, 1> result;
  for (int a = 0; a < 4; ++a) {
    result[a] = bottom * n[a];
    result[4 + a] = top * n[a];
  }
  return result;
}

PALPATE_INLINE Eigen::Matrix<double, 8, 3> Hex8::gradient(const Vector3& xi) noexcept {
  const Eigen::Vector4d n = Quad4::shape({xi[0], xi[1]});
  const Eigen::Matrix<double, 4, 2> d = Quad4::gradient({xi[0], xi[1]});
  const double bottom = 0.5 * (1.0 - xi[2]), top = 0.5 * (1.0 + xi[2]);
  Eigen::Matrix<double, 8, 3> g;
  for (int a = 0; a < 4; ++a) {
    for (int i = 0; i < 2; ++i) {
      g.coeffRef(a, i) = bottom * d.coeff(a, i);
      g.coeffRef(4 + a, i) = top * d.coeff(a, i);
    }
    g.coeffRef(a, 2) = -0.5 * n[a];
    g.coeffRef(4 + a, 2) = 0.5 * n[a];
  }
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 8, 3> Hex8::reference_nodes() noexcept {
  return detail::matrix_of_rows<8, 3>(
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
}

}}  // namespace palpate
