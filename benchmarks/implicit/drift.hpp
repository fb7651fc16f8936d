// Drift of conserved quantities over many implicit steps.
#pragma once

#include "../common/row.hpp"

/// A free block of 2 x 2 x 2 cells over 1 000 000 steps of implicit Euler and of Newmark, at small and at large strain:
/// energy, momentum, angular momentum. Takes minutes.
void measure_implicit_drift(bench::RowFile& rows);
/// The same over fewer steps.
void measure_implicit_drift(bench::RowFile& rows, int steps);
/// Blocks with all free nodes displaced at random: the share that comes to rest.
void measure_implicit_scrambles(bench::RowFile& rows, int runs);
/// Blocks touched at random, of every law and scheme: energy gained beyond the work of the contact.
void measure_energy_in_contact(bench::RowFile& rows, int steps);
/// A fixed sphere in a moving tissue: creep of the tissue over `ticks` ticks.
void measure_static_hold(bench::RowFile& rows, int ticks);
