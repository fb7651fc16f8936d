// Damping of moving bodies, and duration of the free motion whose energy is measured.
#pragma once

namespace tradeoff {

/// Mass-proportional damping [1/s]: a pressed organ comes to rest within a few tenths of a second; steady forces do not
/// change.
inline constexpr double rest_damping = 20.0;
/// Duration of the free motion without damping [s].
inline constexpr double free_swing = 0.1;

}  // namespace tradeoff
