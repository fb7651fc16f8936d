// The inner loops of the contact problem of a tick, chosen for the processor at run time.
#pragma once

#include <palpate/contact/detail/contact_kernels_here.hpp>
#include <palpate/core/detail/for_processor.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fastest kernels of the library for this processor, as processor_kernels().
const any_flags::ContactKernels& contact_kernels() noexcept;

inline const any_flags::ContactKernels& contact_kernels() noexcept {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return for_processor(contacts_here, any_flags::contacts_avx2, any_flags::contacts_avx512);
#else
  return contacts_here;
#endif
}

}}}  // namespace palpate::detail
