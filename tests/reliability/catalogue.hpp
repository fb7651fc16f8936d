// The extremes that a release must pass: id, description, and known criteria that are not reached.
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
    Extreme{"A4", "stiffness contrast of 1e3, 1e6, 1e9 in one mesh"},
    Extreme{"A5", "E, density not positive; elasticity not positive definite"},
    Extreme{"B1", "bodies from 1e-6 m to 1e3 m; millimetres"},
    Extreme{"B2", "far from the origin"},
    Extreme{"B3", "elements without volume"},
    Extreme{"B4", "inverted elements"},
    Extreme{"B5", "slivers"},
    Extreme{"B6", "duplicate nodes and elements, orphan nodes"},
    Extreme{"B7", "disconnected parts"},
    Extreme{"B8", "partly constrained: rigid motions remain"},
    Extreme{"B9", "one element, all nodes constrained, no nodes, no force"},
    Extreme{"B10", "a million elements: memory predicted, or refused"},
    Extreme{"B11", "non-manifold surfaces"},
    Extreme{"C1", "files truncated at every byte"},
    Extreme{"C2", "wrong counts and indices"},
    Extreme{"C3", "coordinates that are not finite decimal numbers"},
    Extreme{"C4", "decimal commas"},
    Extreme{"C5", "line ends, byte order marks, endless lines, wrong format"},
    Extreme{"C6", "caches of other versions and machines, flipped bits"},
    Extreme{"D1", "poses that are NaN, infinite or not a rotation"},
    Extreme{"D2", "a tool that jumps"},
    Extreme{"D3", "a tool that starts inside the tissue"},
    Extreme{"D4", "contacts that change every tick"},
    Extreme{"D5", "missed deadlines"},
    Extreme{"D6", "a device that is lost, fails or repeats itself"},
    Extreme{"D7", "forces over the peak"},
    Extreme{"D8", "forces that change too fast"},
    Extreme{"D9", "two devices, threads, models destroyed while others tick"},
    Extreme{"D10", "tips much smaller than the facets"},
    Extreme{"D11", "many contact points, several tools"},
    Extreme{"D12", "readings lost in contact with thin tissue"},
    Extreme{"D13", "space behind, beside and below an open patch"},
    Extreme{"D14", "motions of one to three radii per tick, plates thinner than the tool"},
    Extreme{"D15", "a grasp through lost readings"},
    Extreme{"E1", "time steps of zero, negative, NaN, 1e-9 s and 1 s"},
    Extreme{"E2", "the stability limit of explicit steps"},
    Extreme{"E3", "a million steps: drift"},
    Extreme{"E4", "large rotations"},
    Extreme{"E5", "bodies crushed, flat, inverted, with all nodes displaced at random"},
    Extreme{"E6", "an unstable motion",
            "a step ten times too long is detected after up to 4 steps; the criterion is 3"},
    Extreme{"E7", "float against double"},
    Extreme{"E8", "denormal numbers"},
    Extreme{"E9", "compiler flags"},
    Extreme{"E10", "every single allocation of a set-up failing"},
    Extreme{"F1", "cutting until the body separates"},
    Extreme{"F2", "cuts through nodes, edges, faces; of zero length; outside the body"},
    Extreme{"F3", "cutting while touching"},
};

}  // namespace reliability
