// Verdict of a cell of a map, and counts of verdicts.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

namespace maps {

/// The only forbidden outcome is `wrong`: a result outside its bound, or an unstable motion, without a warning.
enum class Verdict {
  ok,        ///< within the bound, without a flag
  flagged,   ///< a result with a flag and an error estimate
  refused,   ///< no result, but an error kind
  wrong,     ///< outside the bound without a flag
  unjudged,  ///< not decidable: the reference is too inaccurate
};
inline constexpr int verdict_count = 5;
inline constexpr std::array<const char*, verdict_count> verdict_names{"ok", "flagged", "refused", "WRONG", "unjudged"};

inline const char* name(Verdict v) {
  return verdict_names[static_cast<std::size_t>(v)];
}

struct Counts {
  std::array<int, verdict_count> of{};
  void add(Verdict v) { ++of[static_cast<std::size_t>(v)]; }
  int operator[](Verdict v) const { return of[static_cast<std::size_t>(v)]; }
  int all() const {
    int sum = 0;
    for (int n : of) sum += n;
    return sum;
  }
};

/// Counts by name of the solver or scheme: those of palpate (ours), and those compared with (others).
struct Score {
  std::map<std::string, Counts> ours, others;
  int wrong() const {
    int sum = 0;
    for (const auto& [who, counts] : ours) sum += counts[Verdict::wrong];
    return sum;
  }
};

}  // namespace maps
