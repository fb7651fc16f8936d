// Cutting the shipped organ sixty times a second while it is touched.
#pragma once

#include <string>

#include "../common/row.hpp"

/// Ticks at 1 kHz in this thread, cuts in another, for two seconds each: a slit that grows, and elements that are burnt
/// away. `trace`: a file for the force of every tick, if not empty.
void measure_organ(bench::RowFile& rows, const std::string& trace);
