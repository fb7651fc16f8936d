// The extremes a release has to answer for: an id, what it is, and what is known about laws that cannot be reached.
#pragma once

#include <array>
#include <string_view>

namespace reliability {

struct Extreme {
  std::string_view id, what;
  std::string_view known = {};  ///< a criterion that is not reached, with the measured figure
};

inline constexpr std::array catalogue{
    Extreme{"A1", "Poisson's ratio at and beyond its limits, NaN, infinity"},
    Extreme{"A2", "Poisson's ratio towards 0.5"},
    Extreme{"A3", "Young's modulus from 1 Pa to 1e12 Pa"},
    Extreme{"A4", "contrast of 1e3, 1e6, 1e9 in one mesh"},
    Extreme{"A5", "E, density not positive; elasticity not positive definite"},
    Extreme{"B1", "bodies from 1e-6 m to 1e3 m; millimetres"},
    Extreme{"B2", "far from the origin"},
    Extreme{"B3", "elements without volume"},
    Extreme{"B4", "elements inside out"},
    Extreme{"B5", "slivers"},
    Extreme{"B6", "duplicate nodes and elements, orphans"},
    Extreme{"B7", "pieces that hang loose"},
    Extreme{"B8", "partly held: rigid motions left"},
    Extreme{"B9", "one element, all held, no nodes, no force"},
    Extreme{"B10", "a million elements: memory foretold, or refused"},
    Extreme{"B11", "surfaces that are no manifold"},
    Extreme{"C1", "files cut off at every byte"},
    Extreme{"C2", "counts and indices that lie"},
    Extreme{"C3", "coordinates that are no plain numbers"},
    Extreme{"C4", "decimal commas"},
    Extreme{"C5", "line ends, marks, endless lines, one format taken for another"},
    Extreme{"C6", "caches of other versions and machines, flipped bits"},
    Extreme{"D1", "poses that are NaN, infinite, no rotations"},
    Extreme{"D2", "a tool that leaps"},
    Extreme{"D3", "a tool that starts inside"},
    Extreme{"D4", "contacts that change every tick"},
    Extreme{"D5", "missed deadlines"},
    Extreme{"D6", "a device that is lost, fails or repeats itself"},
    Extreme{"D7", "forces over the peak"},
    Extreme{"D8", "forces that change too fast"},
    Extreme{"D9", "two devices, threads, models that end while others tick"},
    Extreme{"E1", "steps of zero, less, NaN, 1e-9 s and 1 s"},
    Extreme{"E2", "the limit of explicit steps"},
    Extreme{"E3", "a million steps: drift"},
    Extreme{"E4", "large rotations"},
    Extreme{"E5", "crushed, flat, inside out, all nodes thrown about"},
    Extreme{"E6", "a motion that blows up", "a step ten times too long is found after up to 4 steps; 3 are wanted"},
    Extreme{"E7", "float against double"},
    Extreme{"E8", "denormal numbers"},
    Extreme{"E9", "flags of the compiler"},
    Extreme{"E10", "every allocation of a set-up failing in turn"},
    Extreme{"F1", "cutting until the body falls apart"},
    Extreme{"F2", "cuts through nodes, edges, faces; of no length; outside"},
    Extreme{"F3", "cutting while touching"},
};

}  // namespace reliability
