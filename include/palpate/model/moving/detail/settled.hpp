// Initial equilibrium of moving tissue.
#pragma once

#include <palpate/core/types.hpp>
#include <palpate/model/moving/equilibrium.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Displacement of the equilibrium under all loads [m]. Throws not_converged.
VectorX settled(Equilibrium& statics);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/settled.ipp>
#endif
