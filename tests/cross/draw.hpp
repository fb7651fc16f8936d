// Random scenes, with weights that favour what users do, and which pairs of words they cover.
#pragma once

#include "scene.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cross {

/// Everything follows from the number.
Scene draw(std::uint64_t number);

/// What a scene chooses on every axis: its words, and ranges of its numbers.
std::vector<std::pair<std::string, std::string>> choices_of(const Scene& scene);

/// Pairs of choices on two axes: those that occurred, of those that can.
class Coverage {
 public:
  void add(const Scene& scene);
  /// All pairs that can occur, for the compositions that are linked.
  static std::vector<std::string> all();
  /// Those of them that did not.
  std::vector<std::string> missing() const;

 private:
  std::set<std::string> seen_;
};

}  // namespace cross
