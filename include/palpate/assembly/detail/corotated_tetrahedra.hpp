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
#include <palpate/core/rotation.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A `Corotational` body at a displacement, several elements simultaneously: energy, force, and products with the
/// stiffness at constant rotations and cofactors, which is positive semidefinite in every state. Its shear part is
/// R K R^T of Mueller and Gross (2004): that of the linear element with rotated gradients; its volume part is the
/// Gauss-Newton matrix of lambda/2 (J - 1)^2. With the volume part of R K R^T instead, steps diverge at a Poisson ratio
/// of 0.49. Each rotation is computed from that of the previous state. Blocks, sums and vectors as in
/// BatchedTetrahedra; S = float computes products and forces in single precision. No allocation after construction.
template <class S = double, int N = 64 / sizeof(S)>
class CorotatedTetrahedra {
 public:
  using Material = Corotational;

  CorotatedTetrahedra() = default;
  /// Throws as make_batches.
  explicit CorotatedTetrahedra(const HyperelasticBody<Tet4, Material>& body, const SetupLimits& limits = {})
      : layout_(make_batches<S, N>(body, 280.0, limits)) {
    for (const Material& material : body.materials) materials_.push_back(lame<Lane>(material.small_strain()));
    laws_ = body.materials;
    range_.resize(layout_.batches.size());
    rows_.assign(4 * layout_.nodes.size(), S(0));
    reports_.resize(layout_.blocks.size());
    for (const Batch& batch : layout_.batches) rotated_.push_back(at_rest(batch));
  }

  Index size() const noexcept { return 3 * layout_.node_count(); }

  /// The next rotations are computed from those at rest, not from the last ones.
  void forget_rotations() noexcept {
    for (RotatedBatch& rotated : rotated_) rotated.rotation = {Lane(S(1)), Lane(S(0)), Lane(S(0)), Lane(S(0))};
  }
  /// Computes the rotations at u; f = internal force there [N], energy [J]. Finite if |F|^2 is finite in S.
  DeformationReport linearise(const VectorX& u, VectorX& f, double& energy) noexcept {
    energy = 0.0;
    range_.next_turn();
    for (std::size_t b = 0; b < layout_.blocks.size(); ++b) energy += linearise_block(b, u);
    layout_.add_up(rows_.data(), 0, layout_.node_count(), f);
    DeformationReport report = report_of(reports_);
    report.beyond_range = range_.count();
    return report;
  }

  /// y = K x with the stiffness K at the state of the last linearise().
  void apply(const VectorX& x, VectorX& y) const noexcept {
    for (const TetrahedronBlock& block : layout_.blocks) apply_block(block, x);
    layout_.add_up(rows_.data(), 0, layout_.node_count(), y);
  }

  /// Diagonal blocks of K [N/m], symmetric: xx, yy, zz of every node, and xy, xz, yz.
  void diagonal_blocks(VectorX& straight, VectorX& mixed) const noexcept {
    add_diagonals(
        [](const Vector& g, const Vector& c, const Lane& lambda, const Lane& mu) {
          const Lane isotropic = mu * dot(g, g);
          return Vector{isotropic + mu * g.x * g.x + lambda * c.x * c.x,
                        isotropic + mu * g.y * g.y + lambda * c.y * c.y,
                        isotropic + mu * g.z * g.z + lambda * c.z * c.z};
        },
        straight);
    add_diagonals(
        [](const Vector& g, const Vector& c, const Lane& lambda, const Lane& mu) {
          return Vector{mu * g.x * g.y + lambda * c.x * c.y, mu * g.x * g.z + lambda * c.x * c.z,
                        mu * g.y * g.z + lambda * c.y * c.z};
        },
        mixed);
  }

 private:
  using Batch = TetrahedronBatch<S, N>;
  using Lane = Lanes<S, N>;
  using Vector = Triple<Lane>;
  struct Symmetric {
    Lane xx, yy, zz, xy, xz, yz;

    PALPATE_ALWAYS_INLINE static Symmetric part_of(const Tensor3<Lane>& a) noexcept {
      const Lane half(S(0.5f));
      return {a(0, 0),
              a(1, 1),
              a(2, 2),
              half * (a(0, 1) + a(1, 0)),
              half * (a(0, 2) + a(2, 0)),
              half * (a(1, 2) + a(2, 1))};
    }
    PALPATE_ALWAYS_INLINE Vector operator*(const Vector& v) const noexcept {
      return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
    }
  };
  struct RotatedBatch {
    Vector gradient[3];  // R grad N_a sqrt(V)
    Lane root_volume;    // sqrt(V)
    Symmetric cofactor;  // cof(F) R^T
    Quaternion<Lane> rotation;
  };

  static RotatedBatch at_rest(const Batch& batch) {
    RotatedBatch rotated;
    for (int lane = 0; lane < N; ++lane) rotated.root_volume.set(lane, std::sqrt(batch.volume[lane]));
    rotated.rotation = {Lane(S(1)), Lane(S(0)), Lane(S(0)), Lane(S(0))};
    rotate_gradients(Tensor3<Lane>::identity(), batch, rotated);
    rotated.cofactor = Symmetric::part_of(Tensor3<Lane>::identity());
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
    const Lame<Lane> material = materials_[static_cast<std::size_t>(block.region)];
    VolumeWatch<S, N> watch;
    Lane stored(S(0));
    for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
      const Batch& batch = layout_.batches[static_cast<std::size_t>(b)];
      RotatedBatch& rotated = rotated_[static_cast<std::size_t>(b)];
      const Tensor3<Lane> f = batch.deformation_gradient(local), c = cofactor(f),
                          r = tracked_rotation(f, rotated.rotation), d = f - r;
      const Lane ratio = determinant(f, c), swelling = ratio - Lane(S(1));
      watch.observe(ratio, batch.volume);
      range_.observe(static_cast<std::size_t>(b), laws_[static_cast<std::size_t>(block.region)], f, batch.volume);
      stored += batch.volume * corotated_energy(material, d, swelling);
      batch.add_force(corotated_stress(material, d, c, swelling), rows);
      rotate_gradients(r, batch, rotated);
      rotated.cofactor = Symmetric::part_of(c * transpose(r));
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
      const RotatedBatch& rotated = rotated_[static_cast<std::size_t>(b)];
      const Vector(&g)[3] = rotated.gradient;
      const Symmetric& c = rotated.cofactor;
      Vector d[3];
      batch.differences(local, d);
      const Tensor3<Lane> h = outer(d[0], g[0]) + outer(d[1], g[1]) + outer(d[2], g[2]), twice = h + transpose(h);
      const Lane xy = twice(0, 1), xz = twice(0, 2), yz = twice(1, 2);
      const Lane p = lambda * (c.xx * h(0, 0) + c.yy * h(1, 1) + c.zz * h(2, 2) + c.xy * xy + c.xz * xz + c.yz * yz);
      const Lane sxy = mu * xy + p * c.xy, sxz = mu * xz + p * c.xz, syz = mu * yz + p * c.yz;
      const Tensor3<Lane> stress{{mu * twice(0, 0) + p * c.xx, sxy, sxz, sxy, mu * twice(1, 1) + p * c.yy, syz, sxz,
                                  syz, mu * twice(2, 2) + p * c.zz}};
      batch.add_balanced(stress * g[0], stress * g[1], stress * g[2], rows);
    }
  }

  /// Sums part(g, c, lambda, mu) over every element and node; g is its rotated gradient and c the product of cof(F)
  /// with its gradient, times sqrt(V).
  template <class Part>
  void add_diagonals(Part part, VectorX& to) const noexcept {
    for (const TetrahedronBlock& block : layout_.blocks) {
      S* const rows = layout_.cleared(block, rows_);
      const auto [lambda, mu] = materials_[static_cast<std::size_t>(block.region)];
      for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
        const RotatedBatch& rotated = rotated_[static_cast<std::size_t>(b)];
        const Vector(&g)[3] = rotated.gradient;
        const Vector first{-(g[0].x + g[1].x + g[2].x), -(g[0].y + g[1].y + g[2].y), -(g[0].z + g[1].z + g[2].z)};
        const Vector* const all[4] = {&first, &g[0], &g[1], &g[2]};
        for (int a = 0; a < 4; ++a)
          add_rows(rows, layout_.batches[static_cast<std::size_t>(b)].row[a],
                   part(*all[a], rotated.cofactor * *all[a], lambda, mu));
      }
    }
    layout_.add_up(rows_.data(), 0, layout_.node_count(), to);
  }

  TetrahedronBatches<S, N> layout_;
  std::vector<Lame<Lane>> materials_;  // by region
  std::vector<RotatedBatch> rotated_;
  mutable std::vector<S> rows_;             // force on every row, four numbers per row: a workspace
  std::vector<DeformationReport> reports_;  // by block
  std::vector<Material> laws_;              // by region
  RangeWatch<Material, S, N> range_;
};

}}}  // namespace palpate::detail
