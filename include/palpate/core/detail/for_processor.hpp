// The choice between kernels that are compiled for several processors. Included by sources of palpate::compiled only.
#pragma once

#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

#if defined(PALPATE_KERNELS_BY_PROCESSOR)

/// The fastest kernels that this processor executes; `here`, those of the flags of this source, if these already
/// include as much.
template <class Kernels>
const Kernels& for_processor(const Kernels& here, [[maybe_unused]] const Kernels& avx2,
                             [[maybe_unused]] const Kernels& avx512) noexcept {
#if !defined(__AVX512F__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return avx512;
#if !(defined(__AVX2__) && defined(__FMA__))
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return avx2;
#endif
#endif
  return here;
}

#endif

}}}  // namespace palpate::detail
