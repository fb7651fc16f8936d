// How bodies that move are damped, and how long they swing for their energy to be watched.
#pragma once

namespace tradeoff {

/// Damping that lets a pressed organ come to rest within a few tenths of a second and leaves steady forces alone [1/s].
inline constexpr double drag = 20.0;
/// [s]
inline constexpr double free_swing = 0.1;

}  // namespace tradeoff
