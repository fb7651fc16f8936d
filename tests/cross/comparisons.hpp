// Oracles that run a scene a second time in another manner, and how runs are compared.
#pragma once

#include "oracles.hpp"

namespace cross {

/// Whether the body can vibrate: explicit motion always has inertia.
bool has_inertia(const Scene& scene);
/// Two tools that press at one place from opposite sides.
bool is_pinch(const Scene& scene);
/// Whether the body has plane faces.
bool is_box(const Scene& scene);

/// Flags by which a tick reports that its solution is not the only one, or not the final one. That facets are coarse or
/// displacements large is true of two runs alike.
palpate::Status excuses();

/// What differences of forces of runs with this largest force are relative to [N]; not zero where nothing presses.
double force_scale(const Scene& scene, double peak);

/// A finding in a tick; flagged if one of the flags of `excuse` is set in it or shortly before.
Finding at(const char* oracle, const Run& run, int tick, int tool, double found, double expected,
           palpate::Status excuse);

/// Whether a tool reaches a support at an end of a box.
bool presses_support(const Scene& scene);

/// Findings where forces differ by more than `tolerance` of the largest force; with 0 where bits, flags or bounds
/// differ, and then no flag excuses it. Ends at the first silent one. The bounds that the runs state for their points
/// count up to `most_of_points` of the largest force.
std::vector<Finding> compare(const char* name, const Scene& scene, const Run& run, const Run& other, double tolerance,
                             double most_of_points = 0.0);
/// The same only at the end of the second phase; `change` is that of the other run.
std::vector<Finding> compare_at_rest(const char* name, const Scene& scene, const Run& run, const Run& other,
                                     double tolerance, const Change& change = {});

const std::vector<Oracle>& comparisons();
const std::vector<Oracle>& laws_of_physics();
const std::vector<Oracle>& references();

}  // namespace cross
