// Definitions of far_displacement.hpp.
#pragma once

#include <palpate/model/moving/detail/far_displacement.hpp>
#include <palpate/model/admission_report.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE FarDisplacement::FarDisplacement(const BodyParts& parts, const std::vector<Vector3>& positions,
                                                LinearSurroundings& surroundings, double largest)
    : interface_(parts.interface), largest_(largest) {
  const auto position = [&](NodeId i) { return positions[static_cast<std::size_t>(i)]; };
  Vector3 centre = Vector3::Zero();
  for (const NodeId i : interface_) centre += position(i) / static_cast<double>(interface_.size());
  Matrix3 inertia = Matrix3::Zero();
  for (const NodeId i : interface_) {
    const Vector3 r = arm_.emplace_back(position(i) - centre);
    inertia += r.squaredNorm() * Matrix3::Identity() - r * r.transpose();
  }
  if (inertia.trace() > 0.0)  // the second term: nodes on a line do not show a rotation about it
    inverse_inertia_ = (inertia + 1e-6 * inertia.trace() * Matrix3::Identity()).inverse();
  const std::vector<Index>& kept = surroundings.kept();
  VectorX rotated(static_cast<Index>(kept.size())), far(3 * static_cast<Index>(parts.far.nodes.size()));
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const NodeId node = parts.far.nodes[static_cast<std::size_t>(kept[k] / 3)];
      rotated[static_cast<Index>(k)] = Vector3::Unit(axis).cross(position(node) - centre)[kept[k] % 3];
    }
    far.setZero();
    surroundings.extend(rotated, far);
    for (Index i = 0; i < far.size() / 3; ++i) reach_[axis] = std::max(reach_[axis], node_vector(far, i).norm());
  }
  const std::vector<std::uint8_t>& constrained = surroundings.conditions().constrained;
  for (std::size_t i = 0; i < constrained.size(); ++i)
    if (constrained[i] != 0 && !surroundings.is_interface(i)) supports_.push_back({parts.far.nodes[i], constrained[i]});
  displaced_.resize(interface_.size() + supports_.size());
  loaded_.resize(constrained.size());
}

PALPATE_INLINE void FarDisplacement::set_from_load(const VectorX& u) noexcept {
  for (std::size_t i = 0; i < loaded_.size(); ++i) loaded_[i] = node_vector(u, static_cast<Index>(i));
  loads_displace_ = !(displacement_spread(loaded_) <= largest_);
}

PALPATE_INLINE bool FarDisplacement::is_too_large(const VectorX& u) noexcept {
  if (loads_displace_) return true;
  Vector3 mean = Vector3::Zero(), moment = Vector3::Zero();
  std::size_t next = 0;
  for (const NodeId i : interface_) {
    const Vector3& moved = displaced_[next] = node_vector(u, Index{i});
    mean += moved / static_cast<double>(interface_.size());
    moment += arm_[next++].cross(moved);
  }
  for (const Support& support : supports_) {
    displaced_[next] = mean;
    for (int c = 0; c < 3; ++c)
      if ((support.constrained >> c & 1u) != 0) displaced_[next][c] = u[3 * Index{support.node} + c];
    ++next;
  }
  const Vector3 rotation = inverse_inertia_ * moment;
  return !(displacement_spread(displaced_) <= largest_) || !(rotation.cwiseAbs().dot(reach_) <= largest_);
}

}}  // namespace palpate
