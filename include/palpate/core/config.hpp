// Compile-time configuration: ABI namespace, fast-math guard, attributes. Everything else includes this first.
#pragma once

#include <Eigen/Core>

#if !EIGEN_VERSION_AT_LEAST(3, 4, 0)
#error "palpate needs Eigen 3.4 or newer"
#endif

// -ffast-math lets the compiler assume that NaN does not exist; every finite check of the force gate would then be
// folded away and a NaN would reach the device as full force.
#if (defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ == 1)) && \
    !defined(PALPATE_ALLOW_FAST_MATH)
#error "palpate refuses -ffast-math: it removes the NaN checks that guard the device. Build without it."
#endif

// A header x.hpp declares, and has templates and small definitions; x.ipp, or several files .ipp, have the others. In
// header-only use (palpate::palpate), it includes them at its end and every definition is inline. palpate::compiled
// defines PALPATE_COMPILED: its library contains the definitions, and programs that link to it do not compile them. Its
// sources with kernels for other processors (linear/detail/processor_kernels.hpp) define PALPATE_KERNEL_SET, so that
// their inline functions are not merged with those of other flags.
#if defined(PALPATE_KERNEL_SET)
#define PALPATE_HEADER_ONLY 0
#define PALPATE_INLINE
#define PALPATE_ABI_COMPILED PALPATE_KERNEL_SET
#elif defined(PALPATE_COMPILED)
#define PALPATE_HEADER_ONLY 0
#define PALPATE_INLINE
#define PALPATE_ABI_COMPILED _compiled
#else
#define PALPATE_HEADER_ONLY 1
#define PALPATE_INLINE inline
#define PALPATE_ABI_COMPILED
#endif

// The layout of fixed-size Eigen members depends on compiler flags (-mavx512f changes their alignment), the behaviour
// of a refused set-up depends on -fno-exceptions, and the place of the definitions depends on the CMake target. All
// three are part of the namespace, so translation units that differ fail to link instead of corrupting memory or
// missing an exception. See docs/linking.md.
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define PALPATE_HAS_EXCEPTIONS 1
#define PALPATE_ABI_PASTE(align, compiled) v0_align##align##compiled
#else
#define PALPATE_ABI_PASTE(align, compiled) v0_align##align##_no_exceptions##compiled
#endif
#define PALPATE_ABI_NAME(align, compiled) PALPATE_ABI_PASTE(align, compiled)
#define PALPATE_ABI PALPATE_ABI_NAME(EIGEN_MAX_STATIC_ALIGN_BYTES, PALPATE_ABI_COMPILED)

#if defined(__GNUC__) || defined(__clang__)
#define PALPATE_COLD [[gnu::cold]]
#else
#define PALPATE_COLD
#endif

// For kernels on values that fill a vector register: how a call passes them depends on compiler flags.
#if defined(__GNUC__) || defined(__clang__)
#define PALPATE_ALWAYS_INLINE [[gnu::always_inline]] inline
#elif defined(_MSC_VER)
#define PALPATE_ALWAYS_INLINE __forceinline
#else
#define PALPATE_ALWAYS_INLINE inline
#endif

// Parameter types put the namespace into the mangled name of a user's function; return types and variables do not. The
// tag adds it there.
#if defined(__GNUC__) || defined(__clang__)
#define PALPATE_ABI_TAG __attribute__((abi_tag))
#else
#define PALPATE_ABI_TAG
#endif

/// The finite element method for haptics.
namespace palpate { inline namespace PALPATE_ABI PALPATE_ABI_TAG {
}}  // namespace palpate
