// Definitions of linear_surroundings.hpp.
#pragma once

#include <palpate/model/moving/detail/linear_surroundings.hpp>
#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/condensation/detail/schur.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE LinearSurroundings::LinearSurroundings(BlockMatrix stiffness, EssentialConditions conditions,
                                                      const std::vector<Vector3>& positions,
                                                      const std::vector<NodeId>& interface, const SetupLimits& limits)
    : stiffness_(std::move(stiffness)), conditions_(std::move(conditions)), is_interface_(positions.size(), 0) {
  for (const NodeId i : interface) is_interface_[static_cast<std::size_t>(i)] = 1;
  DofLayout layout{{}, positions, {}};
  for (const Index dof : conditions_.free_dofs) {
    layout.node_of_dof.push_back(dof / 3);
    if (is_interface_[static_cast<std::size_t>(dof / 3)] == 0) continue;
    kept_.push_back(dof);
    layout.kept.push_back(conditions_.free_index[static_cast<std::size_t>(dof)]);
  }
  SchurComplement schur = condense(free_matrix(stiffness_, conditions_), layout, limits);
  interior_ = std::move(schur.interior);
  schur_ = std::move(schur.stiffness);
  extension_ = interior_;
  load_ = full_ = detail::zeros(conditions_.dof_count());
  free_ = extended_ = detail::zeros(conditions_.free_count());
  zeros_ = detail::zeros(schur_.rows());
  from_load_ = from_prescribed_ = {full_, zeros_};
  const VectorX values = std::exchange(conditions_.prescribed, full_);
  set_prescribed(values);
}

PALPATE_INLINE bool LinearSurroundings::set_load(const VectorX& load) noexcept {
  bool changed = false;
  for (Index dof = 0; dof < load_.size(); ++dof) {
    const double value = is_interface_[static_cast<std::size_t>(dof / 3)] != 0 ? 0.0 : load[dof];
    changed = changed || value != load_[dof];
    load_[dof] = value;
  }
  if (!changed) return false;
  full_ = load_;
  solve(from_load_);
  return true;
}

PALPATE_INLINE bool LinearSurroundings::set_prescribed(const VectorX& values) noexcept {
  VectorX& own = conditions_.prescribed;
  bool changed = false;
  for (Index dof = 0; dof < own.size(); ++dof) {
    if (!conditions_.is_constrained(dof)) continue;
    changed = changed || own[dof] != values[dof];
    own[dof] = values[dof];
  }
  if (!changed) return false;
  stiffness_.apply(own, full_);
  full_ = -full_;
  solve(from_prescribed_);
  from_prescribed_.displacement += own;
  return true;
}

PALPATE_INLINE void LinearSurroundings::solve(Still& still) noexcept {
  conditions_.gather(full_, free_);
  interior_.eliminate_into(free_, still.kept_load);
  interior_.recover_into(zeros_, free_);
  conditions_.scatter(free_, still.displacement);
}

PALPATE_INLINE void LinearSurroundings::extend(const VectorX& kept, VectorX& u) noexcept {
  extension_.extend_into(kept, extended_);
  conditions_.scatter(extended_, u);
}

namespace detail {

/// y = A x; reads the lower half of A, which is symmetric and stored by columns.
PALPATE_INLINE void symmetric_product(const MatrixX& a, const VectorX& x, VectorX& y) noexcept {
  const Index size = x.size();
  fill(y, 0.0);
  for (Index j = 0; j < size; ++j) {
    const double* const column = a.data() + j * size;
    add_scaled(y.data() + j, x[j], column + j, size - j);
    y[j] += dot(column + j + 1, x.data() + j + 1, size - j - 1);
  }
}

}  // namespace detail

PALPATE_INLINE double SurroundedForces::evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept {
  const double stored = part_->evaluate(u, f, report);
  const Index count = stiffness_.rows();
  for (Index i = 0; i < count; ++i) moved_[i] = u[kept_[static_cast<std::size_t>(i)]];
  detail::symmetric_product(stiffness_, moved_, pulled_);
  for (Index i = 0; i < count; ++i) f[kept_[static_cast<std::size_t>(i)]] += pulled_[i];
  return stored + 0.5 * moved_.dot(pulled_);
}

PALPATE_INLINE std::vector<Index> dofs_in(const BodyPart& part, const BodyPart& other, const std::vector<Index>& dofs) {
  std::vector<Index> made;
  for (const Index dof : dofs)
    made.push_back(3 * Index{part.local(other.nodes[static_cast<std::size_t>(dof / 3)])} + dof % 3);
  return made;
}

PALPATE_INLINE SurroundedStiffness::SurroundedStiffness(const BlockPattern& part, const MatrixX& dense,
                                                        const std::vector<Index>& dofs, const SetupLimits& limits) {
  std::vector<NodeId> nodes;
  for (const Index dof : dofs)
    if (const auto node = static_cast<NodeId>(dof / 3); nodes.empty() || nodes.back() != node) nodes.push_back(node);
  BlockPattern joint{{0}, {}};
  auto next = nodes.begin();
  for (Index row = 0; row < part.rows(); ++row) {
    const auto begin = part.column.begin() + part.row_start[static_cast<std::size_t>(row)],
               end = part.column.begin() + part.row_start[static_cast<std::size_t>(row) + 1];
    if (next != nodes.end() && *next == row)
      std::set_union(begin, end, nodes.begin(), ++next, std::back_inserter(joint.column));
    else
      joint.column.insert(joint.column.end(), begin, end);
    joint.row_start.push_back(static_cast<Index>(joint.column.size()));
  }
  surroundings_ = make_stiffness(std::move(joint), limits);
  for (Index row = 0; row < part.rows(); ++row)
    for (Index p = part.row_start[static_cast<std::size_t>(row)]; p <= part.diagonal(row); ++p)
      position_.push_back(pattern().find(static_cast<NodeId>(row), part.column[static_cast<std::size_t>(p)]));
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const auto row = static_cast<NodeId>(dofs[i] / 3), column = static_cast<NodeId>(dofs[j] / 3);
      if (column > row) continue;
      surroundings_.block(pattern().find(row, column))(dofs[i] % 3, dofs[j] % 3) =
          dense(static_cast<Index>(i), static_cast<Index>(j));
    }
}

PALPATE_INLINE void SurroundedStiffness::add_up(const BlockMatrix& part, BlockMatrix& sum) const noexcept {
  sum.copy_values(surroundings_);
  for (std::size_t p = 0; p < position_.size(); ++p) sum.block(position_[p]) += part.block(static_cast<Index>(p));
}

}}  // namespace palpate
