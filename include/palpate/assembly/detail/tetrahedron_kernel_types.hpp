// Types of the kernels of batched tetrahedra.
#pragma once

#include <palpate/core/config.hpp>

#include <cstdint>

namespace palpate {

// The same types for all compiler flags, as in linear/detail/kernel_types.hpp.
namespace any_flags {

/// Lanes of a batch that the kernels compute: 64 bytes.
template <class S>
inline constexpr int tetrahedra_at_once = 64 / static_cast<int>(sizeof(S));

/// The force of a block of tetrahedra. The layout of TetrahedronBatch does not depend on compiler flags.
template <class S>
struct TetrahedronJob {
  const void* batches;  ///< TetrahedronBatch<S, tetrahedra_at_once<S>>
  std::int64_t batch_count;
  const std::int32_t* nodes;  ///< of every row
  std::int64_t row_count;
  const double* displacement;  ///< three numbers per node of the mesh
  S* rows;                     ///< four numbers per row; the force is added
  S lambda, mu;                ///< Lame's constants
  S* volumes;                  ///< written: smallest, batch, upright, broken of VolumeLanes
};

/// Kernels compiled with the same flags.
struct TetrahedronKernels {
  void (*neo_hookean_double)(const TetrahedronJob<double>&) noexcept;
  void (*neo_hookean_float)(const TetrahedronJob<float>&) noexcept;

  void neo_hookean(const TetrahedronJob<double>& job) const noexcept { neo_hookean_double(job); }
  void neo_hookean(const TetrahedronJob<float>& job) const noexcept { neo_hookean_float(job); }
};

// Defined in palpate::compiled, each in a source of its own (cmake/compiled.cmake).
extern const TetrahedronKernels tetrahedra_avx2, tetrahedra_avx512;

}  // namespace any_flags

}  // namespace palpate
