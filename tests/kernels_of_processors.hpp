#pragma once

#include <utility>
#include <vector>

namespace test {

/// Kernels with the name of the instruction set.
template <class Kernels>
using NamedKernels = std::vector<std::pair<const char*, const Kernels*>>;

/// The kernels that this processor can execute, of those that the library has; null where it has none.
template <class Kernels>
NamedKernels<Kernels> executable(const Kernels& chosen, const Kernels& of_test, const Kernels* avx2,
                                 const Kernels* avx512) {
  NamedKernels<Kernels> all{{"chosen", &chosen}, {"of the test", &of_test}};
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  if (avx2 != nullptr && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    all.emplace_back("avx2", avx2);
  if (avx512 != nullptr && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    all.emplace_back("avx512", avx512);
#else
  static_cast<void>(avx2);
  static_cast<void>(avx512);
#endif
  return all;
}

}  // namespace test
