// Definitions of hex20.hpp.
#pragma once

#include <palpate/element/hex20.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(Element<Hex20>);

PALPATE_INLINE Eigen::Matrix<double, 20, 1> Hex20::shape(const Vector3& xi) noexcept {
  return serendipity::shape<20, 3>(reference_nodes(), xi);
}

PALPATE_INLINE Eigen::Matrix<double, 20, 3> Hex20::gradient(const Vector3& xi) noexcept {
  return serendipity::gradient<20, 3>(reference_nodes(), xi);
}

PALPATE_INLINE Eigen::Matrix<double, 20, 3> Hex20::reference_nodes() noexcept {
  return serendipity::with_middles<20, 3>(Hex8::reference_nodes(), edges);
}

}}  // namespace palpate
