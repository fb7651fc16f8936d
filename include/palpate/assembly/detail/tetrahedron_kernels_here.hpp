// The kernels of batched tetrahedra, compiled with the flags of the including source, and their types.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batch.hpp>
#include <palpate/core/config.hpp>
#include <palpate/material/detail/neo_hookean_stress.hpp>

#include <cstdint>
#include <type_traits>

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

inline namespace PALPATE_ABI { namespace detail {

static_assert(std::is_same_v<NodeId, std::int32_t>);

/// The library and its kernels for other processors are compiled with different flags, and share batches.
template <class S, int N = any_flags::tetrahedra_at_once<S>>
inline constexpr bool same_for_all_flags = sizeof(TetrahedronBatch<S, N>) ==
                                               (9 + 1) * N * sizeof(S) + 4 * N * sizeof(std::uint16_t) &&
                                           alignof(TetrahedronBatch<S, N>) == N * sizeof(S);
static_assert(same_for_all_flags<double> && same_for_all_flags<float>);

template <class S>
inline void add_neo_hookean_block(const any_flags::TetrahedronJob<S>& job) noexcept {
  constexpr int lanes = any_flags::tetrahedra_at_once<S>;
  const auto* const batches = static_cast<const TetrahedronBatch<S, lanes>*>(job.batches);
  const S lambda = job.lambda, mu = job.mu;
  S* const rows = job.rows;
  alignas(64) S local[4 * 4 * tetrahedra_per_block];
  load_relative(job.nodes, job.row_count, job.displacement, local);
  VolumeLanes<S, lanes> volumes;
  for (Index b = 0; b < job.batch_count; ++b) {
    const TetrahedronBatch<S, lanes>& batch = batches[b];
    const Tensor3<Lanes<S, lanes>> f = batch.deformation_gradient(local);
    volumes.observe(determinant(f, cofactor(f)), batch.volume);
    batch.add_force(neo_hookean_stress(f, lambda, mu), rows);
  }
  volumes.smallest.store(job.volumes);
  volumes.batch.store(job.volumes + lanes);
  volumes.upright.store(job.volumes + 2 * lanes);
  volumes.broken.store(job.volumes + 3 * lanes);
}

inline constexpr any_flags::TetrahedronKernels tetrahedra_here{add_neo_hookean_block<double>,
                                                               add_neo_hookean_block<float>};

}}
}  // namespace palpate::detail
