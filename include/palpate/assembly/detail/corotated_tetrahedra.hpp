// Matrix-free force and stiffness of linear tetrahedra in frames that rotate with the elements.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batches.hpp>
#include <palpate/assembly/detail/volume_watch.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lane_rows.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/detail/tracked_rotation.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/detail/small_strain.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A `Corotational` body at a displacement, several elements simultaneously: energy, force, and products with its
/// stiffness at fixed rotations, R K R^T of Mueller and Gross (2004), which is positive semidefinite in every state. An
/// element is the linear one with rotated gradients, so a product costs as much as at small strain. Each rotation is
/// computed from that of the previous state. Blocks, sums and vectors as in BatchedTetrahedra; S = float computes
/// products and forces in single precision. No allocation after construction.
template <class Base = LinearElastic, class S = double, int N = 64 / sizeof(S)>
class CorotatedTetrahedra {
 public:
  using Material = Corotational<Base>;

  CorotatedTetrahedra() = default;
  /// Throws as make_batches.
  explicit CorotatedTetrahedra(const HyperelasticBody<Tet4, Material>& body, const SetupLimits& limits = {})
      : layout_(make_batches<S, N>(body, 280.0, limits)) {
    for (const Material& material : body.materials) materials_.push_back(detail::lame<Lane>(material.base));
    rows_.assign(4 * layout_.nodes.size(), S(0));
    reports_.resize(layout_.blocks.size());
    for (const Batch& batch : layout_.batches) rotated_.push_back(at_rest(batch));
  }

  Index size() const noexcept { return 3 * layout_.node_count(); }
  /// Permanently removes the elements for which gone(element) is true, as in BatchedTetrahedra. O(elements), no
  /// allocation.
  template <class Gone>
  void remove_if(Gone&& gone) {
    layout_.remove_if(gone, [this](std::size_t batch, int lane) {
      for (Vector& g : rotated_[batch].gradient) TetrahedronBatches<S, N>::clear_lane(g, lane);
      rotated_[batch].root_volume.set(lane, S(0));
    });
  }

  /// The next rotations are computed from those at rest, not from the last ones.
  void forget_rotations() noexcept {
    for (RotatedBatch& rotated : rotated_) rotated.rotation = {Lane(S(1)), Lane(S(0)), Lane(S(0)), Lane(S(0))};
  }
  /// Computes the rotations at u; f = internal force there [N], energy [J]. Finite if |F|^2 is finite in S.
  DeformationReport linearise(const VectorX& u, VectorX& f, double& energy) noexcept {
    energy = 0.0;
    for (std::size_t b = 0; b < layout_.blocks.size(); ++b) energy += linearise_block(b, u);
    layout_.add_up(rows_.data(), 0, layout_.node_count(), f);
    return detail::report_of(reports_);
  }

  /// y = R K R^T x with the rotations of the last linearise().
  void apply(const VectorX& x, VectorX& y) const noexcept {
    for (const TetrahedronBlock& block : layout_.blocks) apply_block(block, x);
    layout_.add_up(rows_.data(), 0, layout_.node_count(), y);
  }

  /// Diagonal blocks of R K R^T [N/m], symmetric: xx, yy, zz of every node, and xy, xz, yz.
  void diagonal_blocks(VectorX& straight, VectorX& mixed) const noexcept {
    add_diagonals(
        [](const Vector& g, const Lane& isotropic, const Lane& more) {
          return Vector{isotropic + more * g.x * g.x, isotropic + more * g.y * g.y, isotropic + more * g.z * g.z};
        },
        straight);
    add_diagonals(
        [](const Vector& g, const Lane&, const Lane& more) {
          return Vector{more * g.x * g.y, more * g.x * g.z, more * g.y * g.z};
        },
        mixed);
  }

 private:
  using Batch = TetrahedronBatch<S, N>;
  using Lane = Lanes<S, N>;
  using Vector = Triple<Lane>;
  struct RotatedBatch {
    Vector gradient[3];  // R grad N_a sqrt(V)
    Lane root_volume;    // sqrt(V)
    Quaternion<Lane> rotation;
  };

  static RotatedBatch at_rest(const Batch& batch) {
    RotatedBatch rotated;
    for (int lane = 0; lane < N; ++lane) rotated.root_volume.set(lane, std::sqrt(batch.volume[lane]));
    rotated.rotation = {Lane(S(1)), Lane(S(0)), Lane(S(0)), Lane(S(0))};
    rotate_gradients(Tensor3<Lane>::identity(), batch, rotated);
    return rotated;
  }
  PALPATE_ALWAYS_INLINE static void rotate_gradients(const Tensor3<Lane>& r, const Batch& batch,
                                                     RotatedBatch& to) noexcept {
    const Tensor3<Lane> scaled = to.root_volume * r;
    for (int a = 0; a < 3; ++a) to.gradient[a] = scaled * batch.gradient[a];
  }

  double linearise_block(std::size_t index, const VectorX& u) noexcept {
    const TetrahedronBlock block = layout_.blocks[index];
    alignas(64) S local[4 * TetrahedronBatches<S, N>::most_rows];
    layout_.load_displacements(block, u, local);
    S* const rows = layout_.cleared(block, rows_);
    const detail::Lame<Lane> material = materials_[static_cast<std::size_t>(block.region)];
    detail::VolumeWatch<S, N> watch;
    Lane stored(S(0));
    for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
      const Batch& batch = layout_.batches[static_cast<std::size_t>(b)];
      RotatedBatch& rotated = rotated_[static_cast<std::size_t>(b)];
      const Tensor3<Lane> f = batch.deformation_gradient(local), r = tracked_rotation(f, rotated.rotation), d = f - r;
      watch.observe(determinant(f, cofactor(f)), batch.volume);
      stored += batch.volume * detail::corotated_energy(material, r, d);
      batch.add_force(detail::corotated_stress(material, r, d), rows);
      rotate_gradients(r, batch, rotated);
    }
    reports_[index] = watch.summary(layout_, block, true);
    double sum = 0.0;
    for (int lane = 0; lane < N; ++lane) sum += static_cast<double>(stored[lane]);
    return sum;
  }

  void apply_block(const TetrahedronBlock& block, const VectorX& x) const noexcept {
    alignas(64) S local[4 * TetrahedronBatches<S, N>::most_rows];
    layout_.load_displacements(block, x, local);
    S* const rows = layout_.cleared(block, rows_);
    const auto [lambda, mu] = materials_[static_cast<std::size_t>(block.region)];
    for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
      const Batch& batch = layout_.batches[static_cast<std::size_t>(b)];
      const Vector(&g)[3] = rotated_[static_cast<std::size_t>(b)].gradient;
      Vector d[3];
      batch.differences(local, d);
      const Tensor3<Lane> h = outer(d[0], g[0]) + outer(d[1], g[1]) + outer(d[2], g[2]);
      const Tensor3<Lane> stress = plus_identity(Lane(mu) * (h + transpose(h)), Lane(lambda) * trace(h));
      batch.add_balanced(stress * g[0], stress * g[1], stress * g[2], rows);
    }
  }

  /// Sums part(g, mu V |grad|^2, (lambda + mu)) over every element and node; g is its rotated gradient times sqrt(V).
  template <class Part>
  void add_diagonals(Part part, VectorX& to) const noexcept {
    for (const TetrahedronBlock& block : layout_.blocks) {
      S* const rows = layout_.cleared(block, rows_);
      const auto [lambda, mu] = materials_[static_cast<std::size_t>(block.region)];
      for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
        const Vector(&g)[3] = rotated_[static_cast<std::size_t>(b)].gradient;
        const Vector first{-(g[0].x + g[1].x + g[2].x), -(g[0].y + g[1].y + g[2].y), -(g[0].z + g[1].z + g[2].z)};
        const Vector* const all[4] = {&first, &g[0], &g[1], &g[2]};
        for (int a = 0; a < 4; ++a)
          add_rows(rows, layout_.batches[static_cast<std::size_t>(b)].row[a],
                   part(*all[a], Lane(mu) * dot(*all[a], *all[a]), Lane(lambda + mu)));
      }
    }
    layout_.add_up(rows_.data(), 0, layout_.node_count(), to);
  }

  TetrahedronBatches<S, N> layout_;
  std::vector<detail::Lame<Lane>> materials_;  // by region
  std::vector<RotatedBatch> rotated_;
  mutable std::vector<S> rows_;             // force on every row, four numbers per row: a workspace
  std::vector<DeformationReport> reports_;  // by block
};

}}  // namespace palpate
