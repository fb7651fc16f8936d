// Internal force of tetrahedra at any strain, several elements simultaneously; used for explicit integration.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batches.hpp>
#include <palpate/assembly/detail/tetrahedron_kernels.hpp>
#include <palpate/assembly/detail/volume_watch.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lane_rows.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/quality.hpp>

#include <Eigen/LU>

#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {
/// Total Lagrangian force of linear tetrahedra (Miller, Joldes, Lance, Wittek 2007): F from gradients at rest, f_a = V
/// P grad N_a, Lanes<S, N> of elements simultaneously. Elements are grouped in blocks of 512 that are summed in the
/// cache first, then by node: the order of summation is fixed, independent of the number of threads and of which thread
/// computes which block. Vectors are double, all dofs, in the order of the mesh; S = float computes in single precision
/// from displacement differences within a block. No allocation after construction.
/// With palpate::compiled, kernels for the processor (tetrahedron_kernels) compute the force of NeoHookean; those of
/// different processors differ by rounding. Other materials, and header-only programs, use the program's flags.
template <HyperelasticMaterial M, class S = double, int N = 64 / sizeof(S)>
class BatchedTetrahedra {
 public:
  using Material = M;

  BatchedTetrahedra() = default;
  /// Throws as make_batches.
  explicit BatchedTetrahedra(const HyperelasticBody<Tet4, M>& body, const SetupLimits& limits = {})
      : layout_(detail::make_batches<S, N>(body, 160.0, limits)), materials_(body.materials) {
    rows_.assign(4 * layout_.nodes.size(), S(0));
    reports_.resize(layout_.blocks.size());
    range_.resize(layout_.batches.size());
    probe_length_ =
        std::sqrt(static_cast<double>(std::numeric_limits<S>::epsilon())) * detail::shortest_edge(body.rest.mesh);
  }

  Index size() const noexcept { return 3 * layout_.node_count(); }
  Index block_count() const noexcept { return static_cast<Index>(layout_.blocks.size()); }

  /// force = internal force at displacement u [N]. Where the material is not admissible its stress is added as
  /// computed and the report states it: det F <= 0 for a material that needs det F > 0, or a non-finite value. (Only
  /// LargeStrain checks narrower bounds of a material.)
  DeformationReport force(const VectorX& u, VectorX& f) noexcept {
    range_.next_turn();
    for (Index b = 0; b < block_count(); ++b) compute_block(b, u);
    add_up(0, layout_.node_count(), f);
    return report();
  }

  /// Stored energy [J].
  double energy(const VectorX& u) noexcept {
    double sum = 0.0;
    for (const detail::TetrahedronBlock& block : layout_.blocks) {
      const M material = materials_[static_cast<std::size_t>(block.region)];
      detail::Lanes<S, N> part(S(0));
      layout_.for_each_gradient(
          block, u, [&](const Batch& batch, const Gradient& f) { part += batch.volume * material.energy(f); });
      for (int lane = 0; lane < N; ++lane) sum += static_cast<double>(part[lane]);
    }
    return sum;
  }

  /// A small fraction of the shortest edge [m], chosen so that differences of forces keep half their digits.
  double probe_length() const noexcept { return probe_length_; }

  /// The three parts of force(), for several threads: every block once, in any order; then every node; then the report.
  void compute_block(Index index, const VectorX& u) noexcept {
    const detail::TetrahedronBlock block = layout_.blocks[static_cast<std::size_t>(index)];
    S* const rows = layout_.cleared(block, rows_);
    const M material = materials_[static_cast<std::size_t>(block.region)];
    detail::VolumeWatch<S, N> watch;
    if constexpr (has_kernel) {
      const auto [lambda, mu] = detail::lame<S>(material.small_strain());
      S volumes[4 * N];
      detail::tetrahedron_kernels().neo_hookean({layout_.batches.data() + block.first_batch, block.batch_count,
                                                 layout_.nodes.data() + block.first_row, block.row_count, u.data(),
                                                 rows, lambda, mu, volumes});
      watch.read(volumes);
    } else {
      layout_.for_each_gradient(block, u, [&](const Batch& batch, const Gradient& f) {
        watch.observe(determinant(f, cofactor(f)), batch.volume);
        batch.add_force(material.stress(f), rows);
        if constexpr (!detail::RangedByVolume<M>) observe_range(batch, material, f);
      });
    }
    DeformationReport& report = reports_[static_cast<std::size_t>(index)];
    report = watch.summary(layout_, block, M::survives_inversion);
    report.beyond_range = beyond_range(block, material, u, report.smallest_volume_ratio);
  }
  void add_up(Index first_node, Index last_node, VectorX& f) const noexcept {
    layout_.add_up(rows_.data(), first_node, last_node, f);
  }
  DeformationReport report() const noexcept { return detail::report_of(reports_); }

 private:
  using Batch = detail::TetrahedronBatch<S, N>;
  using Gradient = Tensor3<detail::Lanes<S, N>>;

  void observe_range(const Batch& batch, const M& material, const Gradient& f) noexcept {
    range_.observe(static_cast<std::size_t>(&batch - layout_.batches.data()), material, f, batch.volume);
  }
  /// Elements of a block beyond the range of their material.
  Index beyond_range(const detail::TetrahedronBlock& block, const M& material, const VectorX& u,
                     double smallest) noexcept {
    if constexpr (detail::RangedByVolume<M>) {
      if (smallest > material.range_volume_ratio()) return 0;
      layout_.for_each_gradient(block, u,
                                [&](const Batch& batch, const Gradient& f) { observe_range(batch, material, f); });
    }
    const auto first = static_cast<std::size_t>(block.first_batch);
    return range_.count(first, first + static_cast<std::size_t>(block.batch_count));
  }

  // by processor, with palpate::compiled
  static constexpr bool has_kernel = std::is_same_v<M, NeoHookean> && N == any_flags::tetrahedra_at_once<S>;

  detail::TetrahedronBatches<S, N> layout_;
  std::vector<M> materials_;                // by region
  std::vector<S> rows_;                     // force on every row, four numbers per row
  std::vector<DeformationReport> reports_;  // by block
  detail::RangeWatch<M, S, N> range_;
  double probe_length_ = 0.0;
};

}}  // namespace palpate
