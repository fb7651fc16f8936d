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
    const double x0 = x[3 * i], x1 = x[3 * i + 1], x2 = x[3 * i + 2], diagonal = (*this)[last];
    double y0 = diagonal * x0, y1 = diagonal * x1, y2 = diagonal * x2;
    for (Index p = pattern_.row_start[static_cast<std::size_t>(i)]; p < last; ++p) {
      const Index j = pattern_.column[static_cast<std::size_t>(p)];
      const double m = (*this)[p];
      const double* const xj = x.data() + 3 * j;
      y0 += m * xj[0];
      y1 += m * xj[1];
      y2 += m * xj[2];
      double* const yj = y.data() + 3 * j;
      yj[0] += m * x0;
      yj[1] += m * x1;
      yj[2] += m * x2;
    }
    y[3 * i] += y0;
    y[3 * i + 1] += y1;
    y[3 * i + 2] += y2;
  }
}

}}  // namespace palpate

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void require_mass(double volume, double mass, Index e) {
  if (!std::isfinite(mass)) raise_element(SetupErrorKind::non_finite, e, "has a mass that is not finite");
  if (!(volume > 0.0)) raise_element(SetupErrorKind::inverted_element, e, "has no positive volume");
}

}}}  // namespace palpate::detail
