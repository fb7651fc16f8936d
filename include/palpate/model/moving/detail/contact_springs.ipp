// Definitions of contact_springs.hpp.
#pragma once

#include <palpate/model/moving/detail/contact_springs.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE ContactSprings::ContactSprings(std::size_t vertices, std::size_t most_forces, std::size_t most_points)
    : slot_(vertices, -1), sum_(most_forces), unit_(most_forces), moved_(most_forces), yield_(most_forces) {
  springs_.reserve(most_per_point * most_points);
  forces_of_.reserve(most_per_point * most_points);
}

PALPATE_INLINE void ContactSprings::resize(std::size_t vertices) {
  clear();
  slot_.assign(vertices, -1);
}

PALPATE_INLINE bool ContactSprings::enter(std::span<const VertexForce> forces,
                                          std::span<const PointForce> points) noexcept {
  forces_of_.clear();
  if (forces.size() > moved_.size() || most_per_point * points.size() > springs_.capacity()) return false;
  std::fill(slot_.begin(), slot_.end(), -1);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    slot_[static_cast<std::size_t>(forces[k].vertex)] = static_cast<int>(k);
    sum_[k].setZero();
    unit_[k].setZero();
  }
  for (const PointForce& p : points) {
    const Vector3& force = p.force.in_model_axes();
    const double size = force.norm();
    for (std::size_t a = 0; a < 3; ++a) {
      if (p.weights[a] == 0.0 || size == 0.0) continue;
      if (slot_[static_cast<std::size_t>(p.vertices[a])] < 0) return false;
      sum_[slot(p.vertices[a])] += p.weights[a] * force;
      unit_[slot(p.vertices[a])] += p.weights[a] / size * force;
    }
  }
  return true;
}

PALPATE_INLINE void ContactSprings::add(const PointForce& point, const Vector3& direction, double own,
                                        bool has_friction, const std::vector<NodeId>& nodes) noexcept {
  ContactSpring spring;
  std::array<int, 3> of{-1, -1, -1};
  Vector3 moved = Vector3::Zero();
  double together = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    spring.nodes[a] = nodes[static_cast<std::size_t>(point.vertices[a])];
    spring.weights[a] = point.weights[a];
    if (point.weights[a] == 0.0) continue;
    of[a] = static_cast<int>(slot(point.vertices[a]));
    moved += point.weights[a] * moved_[slot(point.vertices[a])];
    together += point.weights[a] * direction.dot(yield_[slot(point.vertices[a])]);
  }
  const double compliance = std::max(own, together);
  if (!(compliance > 0.0)) return;  // of prescribed vertices
  spring.direction = direction;
  spring.pulls = point.grasped;
  spring.stiffness = stiffness_ / compliance;
  spring.reach = direction.dot(moved) + point.force.in_model_axes().norm() / spring.stiffness;
  springs_.push_back(spring);
  forces_of_.push_back(of);
  if (!has_friction || point.grasped || point.slides) return;
  const Vector3 across = direction.unitOrthogonal();
  spring.pulls = true;
  for (const Vector3& axis : {across, cross(direction, across)}) {
    spring.direction = axis;
    spring.reach = axis.dot(moved);
    springs_.push_back(spring);
    forces_of_.push_back(of);
  }
}

PALPATE_INLINE void ContactSprings::read(const VectorX& u, std::span<VertexForce> forces) const noexcept {
  if (springs_.empty()) return;
  for (VertexForce& f : forces) f.force = {};
  for (std::size_t i = 0; i < springs_.size(); ++i) push(i, springs_[i].push(u), forces);
}

PALPATE_INLINE void ContactSprings::add_change(const VectorX& u, const VectorX& more,
                                               std::span<VertexForce> forces) const noexcept {
  for (std::size_t i = 0; i < springs_.size(); ++i)
    if (springs_[i].pulls || springs_[i].push(u) != 0.0)
      push(i, -springs_[i].stiffness * springs_[i].moved(more), forces);
}

PALPATE_INLINE void ContactSprings::push(std::size_t i, double force, std::span<VertexForce> forces) const noexcept {
  const ContactSpring& spring = springs_[i];
  for (std::size_t a = 0; a < 3; ++a)
    if (forces_of_[i][a] >= 0)
      forces[static_cast<std::size_t>(forces_of_[i][a])].force +=
          ModelVector(spring.weights[a] * force * spring.direction);
}

}}}  // namespace palpate::detail
