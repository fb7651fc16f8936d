// Failures that are known, with their cause. They must keep failing until they are mended; then they become tests.
#pragma once

#include "oracles.hpp"

#include <string>
#include <vector>

namespace cross {

/// A file of known/: a scene, and in comments "# cause: <sentence>", "# oracle: <name>" of every oracle that sees it,
/// first the one that the scene fails, and any number of "# where: <name> <relation> <value>". A failure of one of
/// these oracles whose scene meets all conditions has that cause. Names are those of a scene's values, of any tool's
/// values, and "facets", the length of an edge in radii of the smallest tool, "tools", their number, "moves" and
/// "is_cut", 0 or 1, "torques", 1 where torques differ more than forces, and "part", the size of the value found
/// relative to that expected. Relations: =, !=, <, >.
struct Known {
  struct Condition {
    std::string name, relation, value;
  };
  std::string file, cause;
  std::vector<std::string> oracles;
  std::vector<Condition> where;
  Scene scene;

  bool matches(const Scene& s, const Finding& f) const;
};

/// Throws std::runtime_error, with the file, for one that cannot be read.
std::vector<Known> read_known(const std::string& folder);

}  // namespace cross
