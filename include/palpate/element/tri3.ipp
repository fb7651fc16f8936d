// Definitions of tri3.hpp.
#pragma once

#include <palpate/element/tri3.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Eigen::Matrix<double, 3, 2> Tri3::gradient(const Eigen::Vector2d&) noexcept {
  Eigen::Matrix<double, 3, 2> g;
  g << -1, -1, 1, 0, 0, 1;
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 3, 2> Tri3::reference_nodes() noexcept {
  Eigen::Matrix<double, 3, 2> x;
  x << 0, 0, 1, 0, 0, 1;
  return x;
}

}}  // namespace palpate
