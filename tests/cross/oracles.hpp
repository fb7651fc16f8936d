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
  bool flagged = false;     ///< a status flag reported it
  std::string flags{};      ///< names of the flags
  bool of_torques = false;  ///< `found` and `expected` are torques: forces differ less
};

/// Name of a finding that is a count, not a fault: `found` of `expected` ticks whose force is within 5 % of a reference
/// have a flag. `judge` adds it to the Alarms.
inline constexpr const char* false_alarms = "false alarms";

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
  long ticks = 0, doubted = 0;        ///< of all tools; those with a flag of `doubts`
  long right = 0, right_doubted = 0;  ///< the same of ticks that have the force of a reference
};

struct Verdict {
  std::string refused;
  std::vector<Finding> findings;
  Alarms alarms;
  double seconds = 0.0;
};

/// Runs a scene with the oracles that `choose` accepts. A finding per oracle at most, a silent one where there is one.
Verdict judge(const Scene& scene, const std::function<bool(const Oracle&)>& choose);

}  // namespace cross
