// What implicit steps keep over a long time.
#pragma once

#include "../common/row.hpp"

/// A free block of 2 x 2 x 2 cells over 1 000 000 steps of implicit Euler and of Newmark, at small and at large strain:
/// energy, momentum, angular momentum. Minutes.
void measure_implicit_drift(bench::RowFile& rows);
/// The same over fewer steps.
void measure_implicit_drift(bench::RowFile& rows, int steps);
/// Blocks with all free nodes displaced at random: share that comes to rest.
void measure_implicit_scrambles(bench::RowFile& rows, int runs);
/// A sphere held in a moving tissue: how far the tissue creeps in a million ticks.
void measure_static_hold(bench::RowFile& rows, int ticks);
