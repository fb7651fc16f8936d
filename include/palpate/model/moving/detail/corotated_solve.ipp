// Definitions of corotated_solve.hpp.
#pragma once

#include <palpate/model/moving/detail/corotated_solve.hpp>

#include <Eigen/LU>

#include <numeric>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE CorotatedSolve::CorotatedSolve(const DeformableBody& body, const BlockMatrix* stiffness)
    : conditions_(body.conditions),
      rotations_(body.pattern, body.positions, all_nodes(body.positions.size()), stiffness),
      rotation_(body.positions.size(), Matrix3::Identity()),
      full_(3 * static_cast<Index>(body.positions.size())),
      x_(conditions_.free_count()) {}

PALPATE_INLINE void CorotatedSolve::fit(const VectorX& u, std::vector<Matrix3>& rotation) const noexcept {
  for (std::size_t i = 0; i < rotation.size(); ++i) rotation[i] = rotations_(i, u);
}

PALPATE_INLINE void CorotatedSolve::update(const VectorX& u, const std::vector<Matrix3>& since) noexcept {
  fit(u, rotation_);
  for (std::size_t i = 0; i < rotation_.size(); ++i) rotation_[i] = rotation_[i] * since[i].transpose();
}

PALPATE_INLINE void CorotatedSolve::update_stretched(const VectorX& u) noexcept {
  constexpr double most = 3.0;  // change of volume, and mean square stretch
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const Matrix3 f = rotations_.gradient(i, u);
    const double volume = f.determinant();
    const bool moderate = volume > 1.0 / most && volume < most && f.squaredNorm() < 3.0 * most;
    rotation_[i] = moderate ? f : rotations_(i, u);
  }
}

PALPATE_INLINE void CorotatedSolve::solve(TangentSolver& factor, const VectorX& r, VectorX& z) noexcept {
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(full_, node, rotation_[i].transpose() * node_vector(r, node));
  }
  conditions_.gather(full_, x_);
  factor.solve(x_, x_);
  conditions_.scatter(x_, full_);
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(z, node, rotation_[i] * node_vector(full_, node));
  }
  for (Index dof = 0; dof < z.size(); ++dof)
    if (conditions_.is_constrained(dof)) z[dof] = 0.0;
}

PALPATE_INLINE void CorotatedSolve::apply(const BlockMatrix& a, const VectorX& x, VectorX& y) noexcept {
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(full_, node, rotation_[i].transpose() * node_vector(x, node));
  }
  a.apply(full_, y);
  for (std::size_t i = 0; i < rotation_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(y, node, rotation_[i] * node_vector(y, node));
  }
}

PALPATE_INLINE std::vector<NodeId> CorotatedSolve::all_nodes(std::size_t count) {
  std::vector<NodeId> nodes(count);
  std::iota(nodes.begin(), nodes.end(), NodeId{0});
  return nodes;
}

}}  // namespace palpate
