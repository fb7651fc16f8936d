// Linear tetrahedra with strain averaged over neighbours, at large strain: neither lock nor are too stiff in bending.
#pragma once

#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/assembly/detail/strain_averages.hpp>
#include <palpate/assembly/detail/strain_domains.hpp>
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
#include <palpate/element/wrappers.hpp>
#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/mesh/quality.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Smoothed<Tet4> at large strain. With F_e the mean deformation gradient of the elements around an edge, J_n the mean
/// volume ratio of those around a node, J'_e the mean of J_n over the nodes of the elements around an edge, and F'_e =
/// (J'_e / det F_e)^(1/3) F_e, the stored energy is
///   sum over edges V_e (W(F'_e) - U(J'_e)) + sum over nodes V_n U(J_n),   U(J) = W(J^(1/3) I):
/// the change of volume is averaged over nodes and all else over edges, for any material. (With W(F_e) in place of
/// W(F'_e) a distorted edge of a neo-Hookean body lowers its energy by collapsing.) The tangent at rest is the
/// stiffness of Smoothed<Tet4> at small strain; a uniform deformation has the energy of the material. Below J = 1/8, U
/// continues as a parabola with the bulk modulus at rest, and ratios of volumes are those of 1/8, so that forces stay
/// finite and push an inverted domain back. Materials, vectors and allocation are as in BatchedTetrahedra; a material
/// that needs J > 0 needs it of the edges. S = float computes in single precision. About 350 bytes per element in
/// double, 200 in float.
template <HyperelasticMaterial M, class S = double, int N = 64 / sizeof(S)>
class SmoothedTetrahedra {
 public:
  using Material = M;

  SmoothedTetrahedra() = default;
  /// Throws as make_batches.
  explicit SmoothedTetrahedra(const HyperelasticBody<Smoothed<Tet4>, M>& body, const SetupLimits& limits = {})
      : layout_(detail::make_batches<S, N>(body, 350.0, limits)), materials_(body.materials) {
    for (const Matrix6& d : body.rest.elasticity) bulk_.push_back(static_cast<S>(detail::bulk_modulus(d)));
    average(body.rest.mesh, limits);
    make_room();
    probe_length_ =
        std::sqrt(static_cast<double>(std::numeric_limits<S>::epsilon())) * detail::shortest_edge(body.rest.mesh);
  }

  /// Follows a cut: `mesh` has the elements of the constructor, some with other nodes (copies of nodes, at the same
  /// places), and those with gone(element) are removed. Only what the cut changes is computed again; the forces are
  /// those of a new object, up to the order of sums. Allocates, O(elements), a tenth of the cost of a new one.
  template <class Gone>
  void follow(const Mesh<Smoothed<Tet4>>& mesh, Gone&& gone) {
    std::vector<char> changed(layout_.batches.size(), 0);
    std::vector<std::int32_t> edges, nodes;
    for (std::size_t e = 0; e < place_.size(); ++e) {
      if (place_[e] < 0 || (!gone(static_cast<Index>(e)) && mesh.elements[e] == connectivity_[e])) continue;
      const auto p = static_cast<std::size_t>(place_[e]);
      changed[p / N] = 1;
      edges.insert(edges.end(), edges_of_.begin() + 6 * place_[e], edges_of_.begin() + 6 * place_[e] + 6);
      nodes.insert(nodes.end(), nodes_of_.begin() + 4 * place_[e], nodes_of_.begin() + 4 * place_[e] + 4);
    }
    follow_in(edges_, edges, 6, edges_of_, mesh, gone);
    follow_in(nodes_, nodes, 4, nodes_of_, mesh, gone);
    layout_.remove_if(gone);
    layout_.reconnect(mesh, [&](Index batch) { return changed[static_cast<std::size_t>(batch)] != 0; });
    for (std::size_t e = 0; e < place_.size(); ++e)
      if (gone(static_cast<Index>(e))) place_[e] = -1;
    connectivity_ = mesh.elements;
    make_room();
  }

  Index size() const noexcept { return 3 * layout_.node_count(); }
  double probe_length() const noexcept { return probe_length_; }

  /// f = internal force at displacement u [N]; returns the stored energy [J], infinite where a material is not
  /// admissible (f is then not a force). The report has the volume ratios of elements, which may be inverted while the
  /// averages are not.
  double evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept {
    report = find_gradients(u);
    range_.next_turn();
    const double energy = find_stresses();
    report.beyond_range = range_.count();
    report.admissible = std::isfinite(energy);
    for (const detail::TetrahedronBlock& block : layout_.blocks) add_forces(block);
    layout_.add_up(rows_.data(), 0, layout_.node_count(), f);
    return energy;
  }
  DeformationReport force(const VectorX& u, VectorX& f) noexcept {
    DeformationReport report;
    evaluate(u, f, report);
    return report;
  }
  double energy(const VectorX& u) noexcept {
    find_gradients(u);
    return find_stresses();
  }

 private:
  using Number = detail::Lanes<S, N>;
  using Batch = detail::TetrahedronBatch<S, N>;
  using Gradient = Tensor3<Number>;
  using Averages = detail::StrainAverages<S, N>;
  static constexpr int row_size = Averages::row_size, pressure_place = 9;  // in the row of an edge

  /// U and dU/dJ.
  struct Volume {
    Number energy, pressure;
  };

  PALPATE_ALWAYS_INLINE static Volume volume(const M& material, const Number& bulk, const Number& j) noexcept {
    const Number least(S(0.125)), seen = max(j, least), below = min(j - least, Number(S(0)));
    const Number side = detail::cube_root(seen);
    const Gradient sphere = Gradient::diagonal(side, side, side);
    const Number slope = trace(material.stress(sphere)) / (S(3) * side * side), bent = bulk * below;
    return {material.energy(sphere) + below * (slope + S(0.5) * bent), slope + bent};
  }
  static S* row(std::vector<S>& rows, std::size_t batch) noexcept {
    return rows.data() + static_cast<std::size_t>(row_size * N) * batch;
  }
  PALPATE_ALWAYS_INLINE static void store(const Gradient& t, S* rows) noexcept {
    for (int lane = 0; lane < N; ++lane)
      for (int i = 0; i < 9; ++i) rows[row_size * lane + i] = t.e[i][lane];
  }

  void average(const Mesh<Smoothed<Tet4>>& mesh, const SetupLimits& limits) {
    const auto elements = static_cast<std::size_t>(mesh.element_count());
    const std::size_t places = layout_.batches.size() * N;
    std::vector<double> volumes(elements);
    place_.resize(elements);
    volume_.assign(places, 0.0);
    connectivity_ = mesh.elements;
    for (std::size_t b = 0; b < layout_.elements.size(); ++b)
      for (std::size_t lane = 0; lane < N; ++lane)
        if (const NodeId e = layout_.elements[b][lane]; e >= 0) {
          place_[static_cast<std::size_t>(e)] = static_cast<std::int32_t>(b * N + lane);
          volumes[static_cast<std::size_t>(e)] = volume_[b * N + lane] =
              detail::constant_geometry(mesh, Index{e}).volume;
        }
    const detail::StrainDomains<Smoothed<Tet4>> domains(mesh, detail::NodeElements(mesh), limits,
                                                        detail::DomainContents::elements);
    edges_ = Averages(domains, detail::StrainPart::deviatoric, place_, volumes);
    nodes_ = Averages(domains, detail::StrainPart::volumetric, place_, volumes);
    edges_of_.assign(6 * places, 0);
    nodes_of_.assign(4 * places, 0);
    fill(edges_, 6, edges_of_);
    fill(nodes_, 4, nodes_of_);
    gradients_.assign(row_size * places, S(0));
    ratios_.assign(places, S(1));
  }
  void make_room() {
    stresses_.assign(static_cast<std::size_t>(row_size * edges_.size()), S(0));
    range_.resize(edges_.batches().size());
    pressures_.assign(static_cast<std::size_t>(nodes_.size()), S(0));
    averages_ = pressures_;
    rows_.assign(4 * layout_.nodes.size(), S(0));
  }
  /// Updates edges or nodes, `count` of every element, of which the domains `changed` have changed elements.
  template <class Gone>
  void follow_in(Averages& domains, std::vector<std::int32_t>& changed, std::size_t count,
                 std::vector<std::int32_t>& of_element, const Mesh<Smoothed<Tet4>>& mesh, Gone&& gone) {
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    const auto after = [&](typename Averages::Ends ends, std::int32_t place) {
      const auto p = static_cast<std::size_t>(place);
      const NodeId e = layout_.elements[p / N][p % N];
      if (gone(Index{e})) return Averages::none;
      const auto &from = connectivity_[static_cast<std::size_t>(e)], &to = mesh.elements[static_cast<std::size_t>(e)];
      for (NodeId& node : ends)
        if (node >= 0) node = to[static_cast<std::size_t>(std::ranges::find(from, node) - from.begin())];
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      return ends;
    };
    domains.follow(changed, volume_, 1.0 / static_cast<double>(count), after,
                   [&](std::int32_t place, std::int32_t old, std::int32_t made) {
                     const auto first = of_element.begin() + static_cast<std::ptrdiff_t>(count) * place;
                     std::replace(first, first + static_cast<std::ptrdiff_t>(count), old, made);
                   });
  }
  static void fill(const Averages& domains, std::size_t count, std::vector<std::int32_t>& of_element) {
    std::vector<std::uint8_t> filled(of_element.size() / count, 0);
    domains.for_each_pair([&](std::int32_t domain, std::int32_t element) {
      const auto e = static_cast<std::size_t>(element);
      of_element[count * e + filled[e]++] = domain;
    });
  }

  /// F and det F of all elements.
  DeformationReport find_gradients(const VectorX& u) noexcept {
    DeformationReport report;
    for (const detail::TetrahedronBlock& block : layout_.blocks) {
      detail::VolumeWatch<S, N> watch;
      layout_.for_each_gradient(block, u, [&](const Batch& batch, const Gradient& f) {
        const auto b = static_cast<std::size_t>(&batch - layout_.batches.data());
        const Number j = determinant(f);
        watch.observe(j, batch.volume);
        store(f, row(gradients_, b));
        j.store(ratios_.data() + b * N);
      });
      detail::add_report(watch.summary(layout_, block, true), report);
    }
    return report;
  }
  /// Stresses of edges and pressures of nodes; returns the energy.
  double find_stresses() noexcept {
    double sum = 0.0;
    const auto add = [&](const Number& energy) {
      for (int lane = 0; lane < N; ++lane) sum += static_cast<double>(energy[lane]);
    };
    for (std::size_t b = 0; b < nodes_.batches().size(); ++b) {
      const auto& batch = nodes_.batches()[b];
      const auto region = static_cast<std::size_t>(batch.region);
      const Number j = nodes_.mean_numbers(b, ratios_.data());
      const Volume v = volume(materials_[region], bulk_[region], j);
      j.store(averages_.data() + b * N);
      v.pressure.store(pressures_.data() + b * N);
      add(batch.volume * v.energy);
    }
    for (std::size_t e = 0; e < ratios_.size(); ++e) {
      S mean = S(0);
      for (std::size_t k = 0; k < 4; ++k) mean += averages_[static_cast<std::size_t>(nodes_of_[4 * e + k])];
      ratios_[e] = S(0.25) * mean;
    }
    for (std::size_t b = 0; b < edges_.batches().size(); ++b) add(find_stress(b));
    for (std::size_t e = 0; e < ratios_.size(); ++e) {
      S mean = S(0);
      for (std::size_t k = 0; k < 6; ++k)
        mean += stresses_[static_cast<std::size_t>(row_size * edges_of_[6 * e + k] + pressure_place)];
      ratios_[e] = S(1.0 / 6.0) * mean;
    }
    for (std::size_t b = 0; b < nodes_.batches().size(); ++b)
      (Number::load(pressures_.data() + b * N) + nodes_.mean_numbers(b, ratios_.data(), S(0)))
          .store(pressures_.data() + b * N);
    return std::isfinite(sum) ? sum : infinity;
  }
  /// Stress of the edges of a batch, and the pressure from the change of J'; returns their energies.
  PALPATE_ALWAYS_INLINE Number find_stress(std::size_t b) noexcept {
    const auto& batch = edges_.batches()[b];
    const M material = materials_[static_cast<std::size_t>(batch.region)];
    const Number least(S(0.125)), zero(S(0));
    const Gradient f = edges_.mean_tensors(b, gradients_.data()), c = cofactor(f);
    const Number j = determinant(f, c), own = max(j, least), around = edges_.mean_numbers(b, ratios_.data()),
                 mean = max(around, least), ratio = detail::cube_root(mean) / detail::cube_root(own);
    const Gradient seen = ratio * f;
    range_.observe(b, material, seen, batch.volume);
    const Volume v = volume(material, bulk_[static_cast<std::size_t>(batch.region)], mean / own * j);
    const Gradient stress = material.stress(seen) - (v.pressure * ratio * ratio) * c;
    const Number third = S(1.0 / 3.0) * contract(stress, seen);
    S* const rows = row(stresses_, b);
    store(ratio * stress - select(j > least, third / own, zero) * c, rows);
    const Number pressure = select(around > least, third / mean, zero);
    for (int lane = 0; lane < N; ++lane) rows[row_size * lane + pressure_place] = pressure[lane];
    const Number energy = batch.volume * (material.energy(seen) - v.energy);
    if constexpr (M::survives_inversion)
      return energy;
    else
      return select(j > zero, energy, Number(std::numeric_limits<S>::infinity()));
  }
  void add_forces(const detail::TetrahedronBlock& block) noexcept {
    S* const forces = layout_.cleared(block, rows_);
    for (Index i = block.first_batch; i < block.first_batch + block.batch_count; ++i) {
      const auto b = static_cast<std::size_t>(i);
      Gradient f, stress;
      Number pressure;
      for (int lane = 0; lane < N; ++lane) {
        const std::size_t place = b * N + static_cast<std::size_t>(lane);
        using Row = detail::Lanes<S, 4>;
        Row sum[3] = {Row(S(0)), Row(S(0)), Row(S(0))};
        for (std::size_t k = 0; k < 6; ++k) {
          const S* const from = stresses_.data() + row_size * std::ptrdiff_t{edges_of_[6 * place + k]};
          for (int r = 0; r < 3; ++r) sum[r] += Row::load(from + 4 * r);
        }
        for (int r = 0; r < 9; ++r) stress.e[r].set(lane, sum[r / 4][r % 4]);
        for (int r = 0; r < 9; ++r) f.e[r].set(lane, gradients_[row_size * place + static_cast<std::size_t>(r)]);
        S p = S(0);
        for (std::size_t k = 0; k < 4; ++k) p += pressures_[static_cast<std::size_t>(nodes_of_[4 * place + k])];
        pressure.set(lane, p);
      }
      layout_.batches[b].add_force(S(1.0 / 6.0) * stress + (S(0.25) * pressure) * cofactor(f), forces);
    }
  }

  detail::TetrahedronBatches<S, N> layout_;
  std::vector<M> materials_;  // by region
  std::vector<S> bulk_;       // by region [Pa]
  Averages edges_, nodes_;
  std::vector<std::int32_t> place_;  // of every element in the batches; -1: removed
  std::vector<double> volume_;       // by place [m^3]
  std::vector<Mesh<Smoothed<Tet4>>::Connectivity> connectivity_;
  std::vector<std::int32_t> edges_of_, nodes_of_;  // six and four of every element
  std::vector<S> gradients_, ratios_;              // of elements: F; det F, then averages over nodes and edges
  std::vector<S> stresses_;                        // of edges
  std::vector<S> averages_, pressures_;            // of nodes
  std::vector<S> rows_;                            // forces, four numbers per row of the layout
  detail::RangeWatch<M, S, N> range_;              // of edges
  double probe_length_ = 0.0;
};

}}  // namespace palpate
