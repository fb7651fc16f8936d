// Reduces velocities until their kinetic energy is available.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Scales velocities `v` [m/s] down until the kinetic energy is at most `available` [J]; unchanged when it is. `mass`
/// [kg] of every dof, three per node. A free body keeps its momentum: only velocities relative to the mean are scaled.
/// No allocation.
void limit_kinetic_energy(double available, const VectorX& mass, bool is_free, VectorX& v) noexcept;

inline void limit_kinetic_energy(double available, const VectorX& mass, bool is_free, VectorX& v) noexcept {
  const double kinetic = 0.5 * v.dot(mass.cwiseProduct(v));
  if (!(kinetic > available)) return;
  const Index nodes = v.size() / 3;
  Vector3 mean = Vector3::Zero();
  double total = 0.0;
  if (is_free) {
    for (Index i = 0; i < nodes; ++i) {
      mean += mass[3 * i] * node_vector(v, i);
      total += mass[3 * i];
    }
    mean /= total;
  }
  const double drift = 0.5 * total * mean.squaredNorm(),
               scale = std::sqrt(std::max(0.0, available - drift) / (kinetic - drift));
  for (Index i = 0; i < nodes; ++i) set_node_vector(v, i, mean + scale * (node_vector(v, i) - mean));
}

}}}  // namespace palpate::detail
