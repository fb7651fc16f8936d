// What became of a cell of a map, and how many of each kind there are.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

namespace maps {

/// The one forbidden outcome is `wrong`: an answer outside its bound, or a motion that blew up, without a word.
enum class Verdict {
  ok,        ///< within the bound, and nothing to say
  flagged,   ///< answered, with a flag that says how far to trust it
  refused,   ///< not answered, with a kind of error
  wrong,     ///< outside the bound and silent
  unjudged,  ///< nobody knows the right answer: the reference itself has lost its digits
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

/// By name of the solver or scheme; ours apart from those we compare with.
struct Score {
  std::map<std::string, Counts> ours, others;
  int wrong() const {
    int sum = 0;
    for (const auto& [who, counts] : ours) sum += counts[Verdict::wrong];
    return sum;
  }
};

}  // namespace maps
