// Cuts the shipped organ at 60 Hz while it is touched.
#pragma once

#include <string>

#include "../common/row.hpp"

/// Ticks at 1 kHz in this thread, cuts in another, for two seconds each: a growing slit, and elements that are removed
/// by burning. `trace`: if not empty, a file for the force of every tick.
void measure_organ(bench::RowFile& rows, const std::string& trace);
/// The same with tissue at large strain, steps and ticks in turn in one thread.
void measure_moving_organ(bench::RowFile& rows);
