// Definitions of mass_matrix.hpp.
#pragma once

#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::size_t MassMatrix::bytes() const noexcept {
  return values_.size() * (sizeof(double) + sizeof(NodeId)) + pattern_.row_start.size() * sizeof(Index);
}

PALPATE_INLINE void MassMatrix::apply(const VectorX& x, VectorX& y) const noexcept {
  y.setZero();
  for (Index i = 0; i < pattern_.rows(); ++i) {
    const Index last = pattern_.row_start[static_cast<std::size_t>(i) + 1] - 1;
    const Vector3 xi = x.segment<3>(3 * i);
    Vector3 yi = (*this)[last] * xi;
    for (Index p = pattern_.row_start[static_cast<std::size_t>(i)]; p < last; ++p) {
      const Index j = pattern_.column[static_cast<std::size_t>(p)];
      yi += (*this)[p] * x.segment<3>(3 * j);
      y.segment<3>(3 * j) += (*this)[p] * xi;
    }
    y.segment<3>(3 * i) += yi;
  }
}

}}  // namespace palpate

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void require_mass(double volume, double mass, Index e) {
  if (!std::isfinite(mass)) raise_element(SetupErrorKind::non_finite, e, "has a mass that is not finite");
  if (!(volume > 0.0)) raise_element(SetupErrorKind::inverted_element, e, "has no positive volume");
}

}}}  // namespace palpate::detail
