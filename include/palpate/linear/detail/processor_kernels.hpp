// The dense kernels of the solvers, chosen for the processor at run time.
#pragma once

#include <palpate/linear/detail/kernel_types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fastest kernels of the library for this processor. Header-only programs have only those of their own flags.
/// palpate::compiled on x86-64 (not Windows) also has those for AVX2 and for AVX-512: a program built without -march is
/// as fast as with it. Kernels of different processors differ by rounding.
const any_flags::Kernels& processor_kernels() noexcept;

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/processor_kernels.ipp>
#endif
