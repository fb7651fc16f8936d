// Stress of NeoHookean from Lame's constants.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> neo_hookean_stress(const Tensor3<S>& f, scalar_of<S> lambda,
                                                    scalar_of<S> mu) noexcept {
  const Tensor3<S> c = cofactor(f);
  return mu * f + ((lambda + mu) * determinant(f, c) - (lambda + S(2) * mu)) * c;
}

}}}  // namespace palpate::detail
