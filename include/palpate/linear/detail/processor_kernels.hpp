// The dense kernels of the solvers, chosen for the processor at run time.
#pragma once

#include <palpate/core/detail/for_processor.hpp>
#include <palpate/linear/detail/kernel_types.hpp>
#include <palpate/linear/detail/kernels_here.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fastest kernels of the library for this processor. Header-only programs have only those of their own flags.
/// palpate::compiled on x86-64 (not Windows) also has those for AVX2 and for AVX-512: a program built without -march is
/// as fast as with it. Kernels of different processors differ by rounding.
const any_flags::Kernels& processor_kernels() noexcept;

inline const any_flags::Kernels& processor_kernels() noexcept {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return for_processor(kernels_here, any_flags::kernels_avx2, any_flags::kernels_avx512);
#else
  return kernels_here;
#endif
}

}}}  // namespace palpate::detail
