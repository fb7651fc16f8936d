// Definitions of patch_projection.hpp.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/model/detail/patch_projection.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ColumnBlocks::ColumnBlocks(const BlockPattern& pattern)
    : first_(static_cast<std::size_t>(pattern.rows()) + 1, 0) {
  const auto for_each = [&](auto&& visit) {
    for (Index row = 0; row < pattern.rows(); ++row)
      for (Index p = pattern.row_start[static_cast<std::size_t>(row)]; p < pattern.diagonal(row); ++p)
        visit(static_cast<NodeId>(row), static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(p)]), p);
  };
  for_each([&](NodeId, std::size_t column, Index) { ++first_[column + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  block_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for_each([&](NodeId row, std::size_t column, Index p) {
    block_[static_cast<std::size_t>(next[column]++)] = {row, p};
  });
}

PALPATE_INLINE PatchProjection::PatchProjection(const HalfSpaceSource& source, const ColumnBlocks& columns)
    : source_(source),
      columns_(columns),
      patch_(source),
      load_(source),
      known_(static_cast<std::size_t>(source.mesh.node_count), 0),
      value_of_(known_) {}

PALPATE_INLINE const Matrix3& PatchProjection::boundary_value(NodeId node, const HalfSpaceField& field) {
  const auto i = static_cast<std::size_t>(node);
  if (std::exchange(known_[i], number_) != number_) {
    value_of_[i] = static_cast<int>(values_.size());
    values_.push_back(field.displacement(source_.position(node) - source_.position(patch_.middle())));
  }
  return values_[static_cast<std::size_t>(value_of_[i])];
}

PALPATE_INLINE void PatchProjection::assemble(const UniformStiffness& stiffness, const HalfSpaceField& field) {
  const BlockMatrix& k = *stiffness.matrix;
  const BlockPattern& pattern = k.pattern();
  ++number_;
  values_.clear();
  const auto size = 3 * static_cast<Index>(patch_.free().size());
  matrix_.setZero(size, size);
  for (const NodeId row : patch_.free()) {
    const Index at = 3 * Index{patch_.place(row)};
    for (Index p = pattern.row_start[static_cast<std::size_t>(row)]; p <= pattern.diagonal(row); ++p) {
      const NodeId column = pattern.column[static_cast<std::size_t>(p)];
      const int to = patch_.place(column);
      const Matrix3 block = k.block(p);
      if (to < 0)
        right_.block<3, 3>(at, 0) -= block * boundary_value(column, field);
      else if (3 * to <= at)
        matrix_.block<3, 3>(at, 3 * to) = block;
      else
        matrix_.block<3, 3>(3 * to, at) = block.transpose();
    }
    for (const ColumnBlocks::Block& below : columns_.of(row))
      if (patch_.place(below.row) < 0) {
        const Matrix3 block = k.block(below.position).transpose();
        right_.block<3, 3>(at, 0) -= block * boundary_value(below.row, field);
      }
  }
}

/// A volume averaged around a node that is not free has few free nodes. Near incompressibility it is a constraint that
/// values of the field at nodes do not meet exactly, and there are about as many of those as free nodes: patches lock,
/// and forces on Smoothed<Tet4> were 9 to 18 % too low at nu = 0.4999. Such a domain keeps the bulk modulus of nu =
/// 0.497; what is above it acts with the known mean stress of the field: 1 to 4 %. Values for 0.495 to 0.4975 do the
/// same.
PALPATE_INLINE void PatchProjection::release_cut_domains(const UniformStiffness& stiffness,
                                                         const HalfSpaceField& field) {
  constexpr double kept_bulk = 150.0;  // per shear modulus
  if (source_.domains.empty()) return;
  const double nu = stiffness.poisson_ratio;
  const double bulk = 2.0 * stiffness.shear_modulus * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
  const double released = bulk - kept_bulk * stiffness.shear_modulus;
  if (!(released > 0.0)) return;
  for (const NodeId n : patch_.nodes()) {
    if (patch_.place(n) >= 0) continue;
    const Vector3 offset = source_.position(n) - source_.position(patch_.middle());
    for (const int domain : source_.domains.of_node.of(n))
      release(domain, released, released / bulk * field.mean_stress(offset), field);
  }
}

PALPATE_INLINE void PatchProjection::release(int domain, double bulk, const Vector3& mean_stress,
                                             const HalfSpaceField& field) {
  const VolumeDomains& domains = source_.domains;
  const auto d = static_cast<std::size_t>(domain);
  const auto begin = static_cast<std::size_t>(domains.first[d]), end = static_cast<std::size_t>(domains.first[d + 1]);
  const double volume = domains.volume[d];
  const auto is_free = [&](std::size_t a) { return patch_.place(domains.node[a]) >= 0; };
  Vector3 stress = -mean_stress;  // what the stiffness has in place of it, from the nodes that are not free
  for (std::size_t b = begin; b < end; ++b)
    if (!is_free(b)) stress += bulk * (boundary_value(domains.node[b], field).transpose() * domains.gradient[b]);
  for (std::size_t a = begin; a < end; ++a) {
    if (!is_free(a)) continue;
    const Index row = 3 * Index{patch_.place(domains.node[a])};
    const Vector3 g = volume * domains.gradient[a];
    right_.block<3, 3>(row, 0) += g * stress.transpose();
    for (std::size_t b = begin; b < end; ++b) {
      const Index column = 3 * Index{patch_.place(domains.node[b])};
      if (column >= 0 && column <= row)
        matrix_.block<3, 3>(row, column) -= bulk * (g * domains.gradient[b].transpose());
    }
  }
}

PALPATE_INLINE bool PatchProjection::solve_dense() {
  constexpr double largest_residual = 1e-8;
  const Index size = matrix_.rows();
  solution_.resize(size, 3);
  bool good = right_.allFinite() && matrix_.diagonal().allFinite();
  return good && detail::attempt_unless_refused([&] {
           DenseCholesky factor(matrix_, {});
           VectorX product(size);
           for (Index c = 0; c < 3; ++c) {
             b_ = right_.col(c);
             x_.resize(size);
             factor.solve_into(b_, x_);
             detail::symmetric_product(matrix_, x_.data(), product.data());
             good = good && (product - b_).norm() <= largest_residual * b_.norm();
             solution_.col(c) = x_;
           }
         }) &&
         good;
}

/// Depth of the nearest node below the middle of the patch that is fixed along the normal, in edges; infinite where
/// there is none. What such nodes do to a dent changes within a facet if they are near, and then the compliance that
/// remains without the half-space is not smooth: its sum with the half-space may not even be positive definite. Nodes
/// up to about an edge aside count too: in an unstructured mesh none may be straight below.
PALPATE_INLINE double PatchProjection::support_below(NodeId middle, const Vector3& normal) const noexcept {
  constexpr double beside = 1.2, surface = 0.05;  // edges
  const double length = source_.boundary.length(middle);
  double nearest = infinity;
  for (const NodeId n : patch_.nodes()) {
    if (!detail::is_fixed_along(normal, source_.constrained[static_cast<std::size_t>(n)])) continue;
    const Vector3 path = source_.position(n) - source_.position(middle);
    const double depth = -path.dot(normal);
    if (depth > surface * length && (path + depth * normal).norm() < beside * length)
      nearest = std::min(nearest, depth);
  }
  return nearest / length;
}

PALPATE_INLINE void PatchProjection::solve(int vertex, const Vector3& normal, std::vector<PatchEntry>& entries,
                                           HalfSpaceMarks& marks) {
  const NodeId middle = source_.touched[static_cast<std::size_t>(vertex)];
  const VertexMaterial& material = source_.materials[static_cast<std::size_t>(vertex)];
  const UniformStiffness& stiffness = source_.stiffness[static_cast<std::size_t>(material.stiffness)];
  patch_.find(middle, normal);
  if (patch_.is_cut()) marks.set(HalfSpaceMark::near_edge);
  constexpr double near = 1.3, too_near = 0.7;
  const double support = support_below(middle, normal);
  if (support < near) marks.set(HalfSpaceMark::near_support);
  if (support < too_near) return marks.set(HalfSpaceMark::thin);
  const HalfSpaceField field(stiffness.shear_modulus, stiffness.poisson_ratio, normal);
  load_.compute(patch_, field, normal, right_);
  assemble(stiffness, field);
  release_cut_domains(stiffness, field);
  if (!solve_dense()) return marks.set(HalfSpaceMark::singular);
  for (const NodeId n : patch_.free()) {
    const auto found = std::ranges::lower_bound(source_.touched, n);
    if (found == source_.touched.end() || *found != n) continue;
    entries.push_back({static_cast<int>(found - source_.touched.begin()),
                       stiffness.shear_modulus * solution_.block<3, 3>(3 * Index{patch_.place(n)}, 0)});
  }
  std::ranges::sort(entries, {}, &PatchEntry::vertex);
}

}}  // namespace palpate
