// What must be true of a scene: comparisons with the same scene in another manner, laws of physics, a finer model.
#pragma once

#include "run.hpp"

#include <functional>
#include <string>
#include <vector>

namespace cross {

/// Something that is not as it must be, in one tick of one tool.
struct Finding {
  std::string oracle;
  int tick = 0, tool = 0;
  double found = 0.0, expected = 0.0;
  bool flagged = false;  ///< a status flag reported it
  std::string flags{};   ///< names of the flags
};

/// Added to the flags of a finding where the torques differ, and forces less.
inline constexpr const char* only_torques = " (torques)";

/// A check. `applies` is cheap; `check` may run the scene in other manners.
struct Oracle {
  std::string name;
  double cost;  ///< in runs of the scene, roughly
  bool (*applies)(const Scene& scene);
  std::vector<Finding> (*check)(const Scene& scene, const Run& run);
};

const std::vector<Oracle>& oracles();
const Oracle& find_oracle(const std::string& name);

/// Flags by which a tick reports that its force may be wrong.
palpate::Status doubts();

struct Alarms {
  long ticks = 0, doubted = 0;  ///< of all tools; those with a flag of `doubts`
};

struct Verdict {
  std::string refused;
  std::vector<Finding> findings;
  Alarms alarms;
  double seconds = 0.0;
};

/// Runs a scene with the oracles that `choose` accepts. A finding per oracle at most, a silent one where there is one;
/// and "false alarms", a count that is no fault, where there is a reference.
Verdict judge(const Scene& scene, const std::function<bool(const Oracle&)>& choose);

}  // namespace cross
