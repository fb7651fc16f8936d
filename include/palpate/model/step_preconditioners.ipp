// Definitions of step_preconditioners.hpp.
#pragma once

#include <palpate/model/step_preconditioners.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE BlockJacobi::BlockJacobi(const DeformableBody& body, const Body<Tet4>&, const SetupLimits&)
    : lumped_(body.lumped),
      constrained_(body.conditions.constrained),
      straight_(3 * lumped_.size()),
      mixed_(straight_) {
  inverse_.resize(constrained_.size(), Matrix3::Zero());
}

PALPATE_INLINE void BlockJacobi::change(const DeformableBody& body) {
  lumped_ = body.lumped;
  constrained_ = body.conditions.constrained;
}

PALPATE_INLINE void BlockJacobi::apply(const VectorX& r, VectorX& z) const noexcept {
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const auto at = 3 * static_cast<Index>(i);
    z.segment<3>(at).noalias() = inverse_[i] * r.segment<3>(at);
  }
}

PALPATE_INLINE void BlockJacobi::hold(std::uint8_t constrained, Matrix3& a, Matrix3& inverse) noexcept {
  for (int c = 0; c < 3; ++c)
    if (((constrained >> c) & 1u) != 0) {
      a.row(c).setZero();
      a.col(c).setZero();
      a(c, c) = 1.0;
    }
  inverse = a.inverse();
  for (int c = 0; c < 3; ++c)
    if (((constrained >> c) & 1u) != 0) inverse(c, c) = 0.0;
}

}}  // namespace palpate
