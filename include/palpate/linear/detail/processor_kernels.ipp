// Definitions of processor_kernels.hpp.
#pragma once

#include <palpate/linear/detail/kernels_here.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE const any_flags::Kernels& processor_kernels() noexcept {
#if defined(PALPATE_KERNELS_BY_PROCESSOR) && !defined(__AVX512F__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return any_flags::kernels_avx512;
#if !(defined(__AVX2__) && defined(__FMA__))
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return any_flags::kernels_avx2;
#endif
#endif
  return kernels_here;
}

}}}  // namespace palpate::detail
