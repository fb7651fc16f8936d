// Definitions of turned_solve.hpp.
#pragma once

#include <palpate/model/static/detail/turned_solve.hpp>

#include <numeric>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE TurnedSolve::TurnedSolve(const DeformableBody& body)
    : conditions_(body.conditions),
      rotations_(body.pattern, body.positions, all_nodes(body.positions.size())),
      turn_(body.positions.size(), Matrix3::Identity()),
      full_(3 * static_cast<Index>(body.positions.size())),
      x_(conditions_.free_count()) {}

PALPATE_INLINE void TurnedSolve::fit(const VectorX& u, std::vector<Matrix3>& turn) const noexcept {
  for (std::size_t i = 0; i < turn.size(); ++i) turn[i] = rotations_(i, u);
}

PALPATE_INLINE void TurnedSolve::turn(const VectorX& u, const std::vector<Matrix3>& since) noexcept {
  fit(u, turn_);
  for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = turn_[i] * since[i].transpose();
}

PALPATE_INLINE void TurnedSolve::solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept {
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(full_, node, turn_[i].transpose() * node_vector(r, node));
  }
  conditions_.gather(full_, x_);
  factor.solve(x_, x_);
  conditions_.scatter(x_, full_);
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(z, node, turn_[i] * node_vector(full_, node));
  }
  for (Index dof = 0; dof < z.size(); ++dof)
    if (conditions_.is_constrained(dof)) z[dof] = 0.0;
}

PALPATE_INLINE std::vector<NodeId> TurnedSolve::all_nodes(std::size_t count) {
  std::vector<NodeId> nodes(count);
  std::iota(nodes.begin(), nodes.end(), NodeId{0});
  return nodes;
}

}}  // namespace palpate
