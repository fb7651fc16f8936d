// Lame's constants in the number type of a kernel.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/material/linear_elastic.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Lame's constants [Pa] for a kernel on S.
template <class S>
struct Lame {
  scalar_of<S> lambda, mu;
};

/// Two divisions, which a compiler moves out of a loop when the material is a local variable.
template <class S>
PALPATE_ALWAYS_INLINE Lame<S> lame(const LinearElastic& material) noexcept {
  return {static_cast<scalar_of<S>>(material.lame_lambda()), static_cast<scalar_of<S>>(material.shear_modulus())};
}

}}}  // namespace palpate::detail
