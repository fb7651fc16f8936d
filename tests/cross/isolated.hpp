// Judges a scene in a process of its own, so that a crash or an endless loop is a finding.
#pragma once

#include "oracles.hpp"

namespace cross {

/// As `judge`, with findings "crash" (expected: the signal), "endless" and "exception" besides. `seconds`: of processor
/// time that the scene may take.
Verdict judge_isolated(const Scene& scene, const std::function<bool(const Oracle&)>& choose, int seconds = 120);

}  // namespace cross
