// Charts of the panel, drawn with Dear ImGui.
#pragma once

#include "../core/tick_log.hpp"

namespace live {

/// Force over the last seconds, the band of its error, and below it a strip coloured where the status was not ok.
void draw_force_chart(const TickLog& log, float width, float height);
/// Times of ticks on a logarithmic axis up to the period, with median and 99th percentile.
void draw_tick_histogram(const TickLog& log, double period, float width, float height);
/// One lamp per status flag, lit while ticks have it.
void draw_status(Status status, float width);

}  // namespace live
