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

// Layout of fixed-size Eigen members depends on compiler flags (-mavx2 changes their alignment). The alignment is part
// of the namespace, so translation units with different layouts fail to link instead of corrupting memory.
#define PALPATE_ABI_PASTE(align) v0_align##align
#define PALPATE_ABI_NAME(align) PALPATE_ABI_PASTE(align)
#define PALPATE_ABI PALPATE_ABI_NAME(EIGEN_MAX_STATIC_ALIGN_BYTES)

#if defined(__GNUC__) || defined(__clang__)
#define PALPATE_COLD [[gnu::cold, gnu::noinline]]
#elif defined(_MSC_VER)
#define PALPATE_COLD __declspec(noinline)
#else
#define PALPATE_COLD
#endif

/// The finite element method for haptics.
namespace palpate::inline PALPATE_ABI {}
