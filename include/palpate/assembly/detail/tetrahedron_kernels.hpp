// The kernels of batched tetrahedra, chosen for the processor at run time.
#pragma once

#include <palpate/assembly/detail/tetrahedron_kernels_here.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/for_processor.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fastest kernels of the library for this processor, as processor_kernels().
const any_flags::TetrahedronKernels& tetrahedron_kernels() noexcept;

inline const any_flags::TetrahedronKernels& tetrahedron_kernels() noexcept {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return for_processor(tetrahedra_here, any_flags::tetrahedra_avx2, any_flags::tetrahedra_avx512);
#else
  return tetrahedra_here;
#endif
}

}}}  // namespace palpate::detail
