// The compositions that were tried, side by side.
#pragma once

#include "../core/stage.hpp"

#include <map>

namespace live {

/// What was measured while a composition was touched.
struct Trial {
  double force = 0.0;              ///< [N] last one in contact
  double bound = infinity;         ///< [N] of its error
  double median = 0.0, p99 = 0.0;  ///< [s] ticks
  double set_up = 0.0;             ///< [s]
};

using Trials = std::map<Composition, Trial>;

inline void note_trial(Stage& stage, Composition composition, Trials& trials) {
  if (!stage.running() || stage.log().ticks() == 0) return;
  Trial& trial = trials[composition];
  const TickLog& log = stage.log(stage.hand().active());
  trial.set_up = stage.organ()->set_up_seconds;
  trial.median = log.compute().percentile(0.5);
  trial.p99 = log.compute().percentile(0.99);
  const double force = log.newest().tick.force.norm();
  if (!(force > 1e-3)) return;
  trial.force = force;
  trial.bound = log.newest().tick.error_bound;
}

}  // namespace live
