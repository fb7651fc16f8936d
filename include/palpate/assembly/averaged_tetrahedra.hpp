// Linear tetrahedra without volumetric locking: the change of volume is averaged over neighbours.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batches.hpp>
#include <palpate/assembly/detail/volume_watch.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/quality.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Linear tetrahedra with the average nodal Jacobian of Joldes, Wittek and Miller (2009): J of a node is the
/// volume-weighted mean over its elements, J' of an element is the mean over its nodes, and the material is evaluated
/// at F' = (J'/J)^(1/3) F. The paper uses V P(F') grad N_a as the force, which does not derive from an energy; here the
/// force is the complete derivative of
///   sum over elements of V W(F'),
/// so that energy and angular momentum are conserved. This costs one more sweep over the elements: three in total.
/// Averages do not cross region borders: a node between two regions has one J in each. This is not the small-strain
/// element Smoothed<Tet4>, which averages the change of volume once, to nodes, and also averages the deviatoric strain
/// over edges; here the deviatoric part stays per element. Below J = 0.1 an element counts as 0.1 in the ratio, so that
/// the force stays finite; inverted elements recover less reliably than those of BatchedTetrahedra. Materials, vectors
/// and allocation are as in BatchedTetrahedra.
template <HyperelasticMaterial M, class S = double, int N = 64 / sizeof(S)>
class AveragedTetrahedra {
 public:
  using Material = M;

  AveragedTetrahedra() = default;
  /// Throws as make_batches.
  explicit AveragedTetrahedra(const HyperelasticBody<Tet4, M>& body, const SetupLimits& limits = {})
      : layout_(make_batches<S, N>(body, 180.0, limits)), materials_(body.materials) {
    rows_.assign(4 * layout_.nodes.size(), S(0));
    sums_.assign(layout_.nodes.size(), S(0));
    range_.resize(layout_.batches.size());
    place_averages();
    for (const TetrahedronBlock& block : layout_.blocks)
      for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
        const Batch& batch = layout_.batches[static_cast<std::size_t>(b)];
        add_to_rows(batch, sums_.data() + block.first_row, batch.volume);
      }
    gather_sums(inverse_volume_);
    inverse_volume_ = inverse_volume_.cwiseInverse();
    probe_length_ = std::sqrt(static_cast<double>(std::numeric_limits<S>::epsilon())) * shortest_edge(body.rest.mesh);
  }

  Index size() const noexcept { return 3 * layout_.node_count(); }
  double probe_length() const noexcept { return probe_length_; }

  /// force = internal force at displacement u [N]. The report is about the elements' own J; a material that needs J >
  /// 0 is reported as inadmissible where J <= 0.
  DeformationReport force(const VectorX& u, VectorX& f) noexcept {
    DeformationReport report = average_volumes(u);
    range_.next_turn();
    clear(sums_);
    for_each_element(u, [&](const TetrahedronBlock& block, const Batch& batch, const Gradient& gradient) {
      const Averaged a = averaged(block, batch, gradient);
      range_.observe(static_cast<std::size_t>(&batch - layout_.batches.data()), material_of(block), a.ratio * gradient,
                     batch.volume);
      const Number share = S(0.25f) * batch.volume * a.pressure / a.mean;
      add_to_rows(batch, sums_.data() + block.first_row, select(a.mean > least(), share, Number(S(0))));
    });
    report.beyond_range = range_.count();
    gather_sums(pressure_);
    pressure_ = pressure_.cwiseProduct(inverse_volume_);

    clear(rows_);
    for_each_element(u, [&](const TetrahedronBlock& block, const Batch& batch, const Gradient& gradient) {
      const Averaged a = averaged(block, batch, gradient);
      const Number own = select(a.own > least(), a.pressure / a.own, Number(S(0)));
      const Number around = S(4) * mean_of_nodes(block, batch, pressure_);
      batch.add_force(a.ratio * a.stress + (around - own) * cofactor(gradient), rows_.data() + 4 * block.first_row);
    });
    layout_.add_up(rows_.data(), 0, layout_.node_count(), f);
    return report;
  }

  /// Stored energy, of which force() is the derivative [J].
  double energy(const VectorX& u) noexcept {
    average_volumes(u);
    double sum = 0.0;
    for_each_element(u, [&](const TetrahedronBlock& block, const Batch& batch, const Gradient& gradient) {
      const Number part = batch.volume * material_of(block).energy(averaged(block, batch, gradient).ratio * gradient);
      for (int lane = 0; lane < N; ++lane) sum += static_cast<double>(part[lane]);
    });
    return sum;
  }

 private:
  using Number = Lanes<S, N>;
  using Batch = TetrahedronBatch<S, N>;
  using Gradient = Tensor3<Number>;

  /// Material response at F', and the volume ratios used.
  struct Averaged {
    Number own, mean, ratio, pressure;  ///< J and J', at least 0.1; (J'/J)^(1/3); P : F' / 3 [Pa]
    Gradient stress;
  };

  static Number least() noexcept { return Number(S(0.1f)); }
  const M& material_of(const TetrahedronBlock& block) const noexcept {
    return materials_[static_cast<std::size_t>(block.region)];
  }
  static void clear(std::vector<S>& values) noexcept { std::fill(values.begin(), values.end(), S(0)); }

  PALPATE_ALWAYS_INLINE Averaged averaged(const TetrahedronBlock& block, const Batch& batch,
                                          const Gradient& f) const noexcept {
    Averaged a;
    a.own = max(determinant(f), least());
    a.mean = max(mean_of_nodes(block, batch, volume_ratio_), least());
    a.ratio = cbrt(a.mean / a.own);
    const Gradient seen = a.ratio * f;
    a.stress = material_of(block).stress(seen);
    a.pressure = S(1.0 / 3.0) * contract(a.stress, seen);
    return a;
  }
  Number mean_of_nodes(const TetrahedronBlock& block, const Batch& batch, const VectorX& averages) const noexcept {
    const std::int32_t* const places = place_.data() + block.first_row;
    Number mean;
    for (int lane = 0; lane < N; ++lane) {
      double sum = 0.0;
      for (int a = 0; a < 4; ++a) sum += averages[places[batch.row[a][lane] / 4]];
      mean.set(lane, static_cast<S>(0.25 * sum));
    }
    return mean;
  }
  static void add_to_rows(const Batch& batch, S* sums, const Number& value) noexcept {
    for (int lane = 0; lane < N; ++lane)
      for (int a = 0; a < 4; ++a) sums[batch.row[a][lane] / 4] += value[lane];
  }
  /// Numbers the averages: one per node and region with elements at that node.
  void place_averages() {
    std::vector<std::pair<NodeId, int>> pairs;
    for (const TetrahedronBlock& block : layout_.blocks)
      for (Index r = 0; r < block.row_count; ++r)
        pairs.emplace_back(layout_.nodes[static_cast<std::size_t>(block.first_row + r)], block.region);
    auto sorted = pairs;
    std::ranges::sort(sorted);
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    for (const auto& pair : pairs)
      place_.push_back(static_cast<std::int32_t>(std::ranges::lower_bound(sorted, pair) - sorted.begin()));
    inverse_volume_ = volume_ratio_ = pressure_ = VectorX::Ones(static_cast<Index>(sorted.size()));
  }
  void gather_sums(VectorX& averages) const noexcept {
    averages.setZero();
    for (std::size_t r = 0; r < place_.size(); ++r) averages[place_[r]] += static_cast<double>(sums_[r]);
  }
  DeformationReport average_volumes(const VectorX& u) noexcept {
    DeformationReport report;
    clear(sums_);
    for (const TetrahedronBlock& block : layout_.blocks) {
      detail::VolumeWatch<S, N> watch;
      layout_.for_each_gradient(block, u, [&](const Batch& batch, const Gradient& gradient) {
        const Number j = determinant(gradient);
        watch.observe(j, batch.volume);
        add_to_rows(batch, sums_.data() + block.first_row, batch.volume * j);
      });
      detail::add_report(watch.summary(layout_, block, M::survives_inversion), report);
    }
    gather_sums(volume_ratio_);
    volume_ratio_ = volume_ratio_.cwiseProduct(inverse_volume_);
    return report;
  }
  template <class Visit>
  PALPATE_ALWAYS_INLINE void for_each_element(const VectorX& u, Visit&& visit) const noexcept {
    for (const TetrahedronBlock& block : layout_.blocks)
      layout_.for_each_gradient(block, u,
                                [&](const Batch& batch, const Gradient& gradient) { visit(block, batch, gradient); });
  }

  TetrahedronBatches<S, N> layout_;
  std::vector<M> materials_;                          // by region
  std::vector<S> rows_, sums_;                        // by row: force, four numbers; a number
  std::vector<std::int32_t> place_;                   // by row: index of the average
  VectorX inverse_volume_, volume_ratio_, pressure_;  // by node and region; volume of its elements in that region
  detail::RangeWatch<M, S, N> range_;
  double probe_length_ = 0.0;
};

}}  // namespace palpate
