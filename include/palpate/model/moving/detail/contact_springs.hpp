// The contacts of a tick as springs for the steps of a tissue.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/contact_spring.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Springs between the tools, where a tick has left them, and the points that they press. A spring has the force of the
/// tick where the point is displaced as in the tick, and follows the point's displacement from there. A step with them
/// ends near the equilibrium of the contact. With dead loads it would end in an equilibrium of the loads: beyond about
/// half a radius that is another one, or unstable. When ticks and steps agree, forces and displacements do not depend
/// on the stiffness of the springs (a Robin condition between the parts of a partitioned problem; Badia, Nobile and
/// Vergara 2008). Friction holds a point along the surface, too, by springs across its force: with dead loads across,
/// sticking points would swing from step to step and begin to slip. Only the constructor and `resize` allocate.
class ContactSprings {
 public:
  static constexpr std::size_t most_per_point = 3;
  /// Stiffness of all springs together, relative to that of the tissue under them. Softer springs do not hold a state
  /// that is unstable under dead loads; stiffer ones take more iterations of a step.
  static constexpr double usual_stiffness = 3.0;

  ContactSprings() = default;
  /// For a surface of `vertices`, and at most that many forces on vertices and points.
  ContactSprings(std::size_t vertices, std::size_t most_forces, std::size_t most_points);

  /// For a surface of another number of vertices. Clears.
  void resize(std::size_t vertices);
  void clear() noexcept { springs_.clear(); }
  /// Another stiffness than the usual one, from the next `set` on.
  void set_stiffness(double relative) noexcept { stiffness_ = relative; }
  double stiffness() const noexcept { return stiffness_; }
  bool empty() const noexcept { return springs_.empty(); }
  std::span<const ContactSpring> all() const noexcept { return springs_; }

  /// Sets springs for the forces of points on the vertices of `forces`, one per vertex. `moved(v)` is the displacement
  /// of a vertex without forces, `compliance(i, j)` that per force, `nodes` those of the vertices. Without springs
  /// where a point has another vertex. O(forces^2).
  template <class Moved, class Compliance>
  void set(std::span<const VertexForce> forces, std::span<const PointForce> points, bool has_friction,
           const std::vector<NodeId>& nodes, const Moved& moved, const Compliance& compliance) noexcept {
    clear();
    if (!enter(forces, points)) return;
    for (std::size_t k = 0; k < forces.size(); ++k) {
      moved_[k] = moved(forces[k].vertex);
      yield_[k].setZero();
      for (std::size_t l = 0; l < forces.size(); ++l) {
        const Matrix3 c = compliance(forces[k].vertex, forces[l].vertex);
        moved_[k] += c * sum_[l];
        yield_[k] += c * unit_[l];
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(points[i].force.in_model_axes().squaredNorm() > 0.0)) continue;
      double own = 0.0, largest = 0.0;
      const Vector3 direction = points[i].force.in_model_axes().normalized();
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          if (const double weight = points[i].weights[a] * points[i].weights[b]; weight > 0.0) {
            const double along = direction.dot(compliance(points[i].vertices[a], points[i].vertices[b]) * direction);
            own += weight * along;
            if (a == b) largest = std::max(largest, along);
          }
      // Beside prescribed vertices a small part of the force is on a free one: not as stiff as that part alone.
      add(points[i], direction, std::max(own, largest / 9.0), has_friction, nodes);
    }
  }
  /// Sets the forces that `set` was given to those of the springs at displacements u of all nodes.
  void read(const VectorX& u, std::span<VertexForce> forces) const noexcept;
  /// Adds to these forces what the springs add to them when nodes at displacements u move by `more`.
  void add_change(const VectorX& u, const VectorX& more, std::span<VertexForce> forces) const noexcept;

 private:
  /// Numbers the vertices with forces and adds up their points' forces and directions. False where a point has none.
  bool enter(std::span<const VertexForce> forces, std::span<const PointForce> points) noexcept;
  void add(const PointForce& point, const Vector3& direction, double own, bool has_friction,
           const std::vector<NodeId>& nodes) noexcept;
  /// Adds a force along the direction of spring i to those on its vertices.
  void push(std::size_t i, double force, std::span<VertexForce> forces) const noexcept;
  std::size_t slot(int vertex) const noexcept {
    return static_cast<std::size_t>(slot_[static_cast<std::size_t>(vertex)]);
  }

  double stiffness_ = usual_stiffness;
  std::vector<ContactSpring> springs_;
  std::vector<std::array<int, 3>> forces_of_;  // per spring: the forces on its vertices
  std::vector<int> slot_;                      // per vertex: number of its force
  // Per force: sum of the points' forces and of their directions, displacement of its vertex by each.
  std::vector<Vector3> sum_, unit_, moved_, yield_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/contact_springs.ipp>
#endif
