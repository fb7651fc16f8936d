#include "oracles.hpp"

#include "comparisons.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace cross {

using palpate::Status;
using palpate::StatusFlag;

Status doubts() {
  Status s;
  for (int bit = 0; bit < palpate::status_flag_count; ++bit) {
    const auto flag = static_cast<StatusFlag>(1u << bit);
    const bool only_limits = flag == StatusFlag::saturated || flag == StatusFlag::slew_limited ||
                             flag == StatusFlag::deadline_missed || flag == StatusFlag::ramping;
    if (!only_limits) s.set(flag);
  }
  return s;
}

const std::vector<Oracle>& oracles() {
  static const std::vector<Oracle> all = [] {
    std::vector<Oracle> list;
    for (const auto* some : {&laws_of_physics(), &comparisons(), &references()})
      list.insert(list.end(), some->begin(), some->end());
    return list;
  }();
  return all;
}

const Oracle& find_oracle(const std::string& name) {
  for (const Oracle& o : oracles())
    if (o.name == name) return o;
  throw std::runtime_error("there is no oracle \"" + name + "\"");
}

Verdict judge(const Scene& scene, const std::function<bool(const Oracle&)>& choose) {
  const auto start = std::chrono::steady_clock::now();
  Verdict verdict;
  const Run r = run(scene);
  verdict.refused = r.refused;
  for (const auto& tick : r.ticks)
    for (const ToolTick& t : tick) {
      ++verdict.alarms.ticks;
      verdict.alarms.doubted += (t.status.bits() & doubts().bits()) != 0;
    }
  for (const Oracle& oracle : oracles()) {
    if (!choose(oracle) || !oracle.applies(scene)) continue;
    if (!r.refused.empty() && oracle.cost > 1) continue;  // a refusal is compared with others, no more
    for (const Finding& f : oracle.check(scene, r)) {
      if (f.oracle == false_alarms) {
        verdict.alarms.right += static_cast<long>(f.expected);
        verdict.alarms.right_doubted += static_cast<long>(f.found);
        continue;
      }
      const auto before = std::find_if(verdict.findings.begin(), verdict.findings.end(),
                                       [&](const Finding& other) { return other.oracle == f.oracle; });
      if (before == verdict.findings.end())
        verdict.findings.push_back(f);
      else if (before->flagged && !f.flagged)
        *before = f;
    }
  }
  verdict.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return verdict;
}

}  // namespace cross
