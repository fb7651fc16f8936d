// The kernels of batched tetrahedra, chosen for the processor at run time.
#pragma once

#include <palpate/assembly/detail/tetrahedron_kernel_types.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fastest kernels of the library for this processor, as processor_kernels().
const any_flags::TetrahedronKernels& tetrahedron_kernels() noexcept;

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/tetrahedron_kernels.ipp>
#endif
