// Definitions of processor_kernels.hpp.
#pragma once

#include <palpate/core/detail/for_processor.hpp>
#include <palpate/linear/detail/kernels_here.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE const any_flags::Kernels& processor_kernels() noexcept {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return for_processor(kernels_here, any_flags::kernels_avx2, any_flags::kernels_avx512);
#else
  return kernels_here;
#endif
}

}}}  // namespace palpate::detail
