// Definitions of quad8.hpp.
#pragma once

#include <palpate/element/quad8.hpp>
#include <palpate/element/quad4.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TriangulatedFace<Quad8>);

PALPATE_INLINE Eigen::Matrix<double, 8, 1> Quad8::shape(const Eigen::Vector2d& xi) noexcept {
  return serendipity::shape<8, 2>(reference_nodes(), xi);
}

PALPATE_INLINE Eigen::Matrix<double, 8, 2> Quad8::gradient(const Eigen::Vector2d& xi) noexcept {
  return serendipity::gradient<8, 2>(reference_nodes(), xi);
}

PALPATE_INLINE Eigen::Matrix<double, 8, 2> Quad8::reference_nodes() noexcept {
  return serendipity::with_middles<8, 2>(Quad4::reference_nodes(), edges);
}

}}  // namespace palpate
