// A contact as a step of a motion sees it.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Maximum number of springs of a motion.
inline constexpr std::size_t most_springs = 2048;

/// A spring that pushes a point of the surface along a direction, and pulls it only where a tool holds it.
struct ContactSpring {
  std::array<NodeId, 3> nodes{};     ///< of the point's facet
  std::array<double, 3> weights{};   ///< of the point
  Vector3 direction{0.0, 0.0, 1.0};  ///< of the push, unit
  double reach = 0.0;                ///< displacement along `direction` from which on there is no push [m]
  double stiffness = 1.0;            ///< [N/m]
  bool pulls = false;                ///< also beyond `reach`

  /// Displacement of the point along `direction` at displacements u, 3 per node [m].
  double moved(const VectorX& u) const noexcept {
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) sum += weights[a] * direction.dot(node_vector(u, Index{nodes[a]}));
    return sum;
  }
  /// Force along `direction` at displacements u, 3 per node [N].
  double push(const VectorX& u) const noexcept {
    return stiffness * (pulls ? reach - moved(u) : std::max(0.0, reach - moved(u)));
  }
  /// Energy at displacements u [J].
  double energy(const VectorX& u) const noexcept {
    const double force = push(u);
    return 0.5 * force * force / stiffness;
  }
};

namespace detail {

/// Copies at most `most_springs` into a vector with room for them.
inline void copy_springs(std::span<const ContactSpring> springs, std::vector<ContactSpring>& into) noexcept {
  const auto count = static_cast<std::ptrdiff_t>(std::min(springs.size(), most_springs));
  into.assign(springs.begin(), springs.begin() + count);
}

/// Adds the forces of springs at displacements u to `force`, 3 entries per node [N]. Returns their energy [J].
inline double add_pushes(std::span<const ContactSpring> springs, const VectorX& u, VectorX& force) noexcept {
  double energy = 0.0;
  for (const ContactSpring& s : springs) {
    const double push = s.push(u);
    for (std::size_t a = 0; a < 3; ++a) add_node_vector(force, Index{s.nodes[a]}, s.weights[a] * push * s.direction);
    energy += s.energy(u);
  }
  return energy;
}

}  // namespace detail

}}  // namespace palpate
