// Definitions of step_preconditioners.hpp.
#pragma once

#include <palpate/model/moving/detail/step_preconditioners.hpp>

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
    const auto node = static_cast<Index>(i);
    set_node_vector(z, node, inverse_[i] * node_vector(r, node));
  }
}

PALPATE_INLINE void BlockJacobi::hold(std::uint8_t constrained, Matrix3& a, Matrix3& inverted) noexcept {
  for (int c = 0; c < 3; ++c)
    if (((constrained >> c) & 1u) != 0) {
      for (int i = 0; i < 3; ++i) a(c, i) = a(i, c) = i == c ? 1.0 : 0.0;
    }
  inverted = inverse(a);
  for (int c = 0; c < 3; ++c)
    if (((constrained >> c) & 1u) != 0) inverted(c, c) = 0.0;
}

}}  // namespace palpate
