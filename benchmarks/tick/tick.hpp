// The measurements of the program.
#pragma once

#include "../common/row.hpp"
#include "../common/touching.hpp"

namespace tick {

void measure_hot(bench::RowFile& rows, bench::Touching& body);
void measure_cold(bench::RowFile& rows, bench::Touching& body);
void measure_products(bench::RowFile& rows);
void measure_calls(bench::RowFile& rows, bench::Touching& body);
void measure_10_khz(bench::RowFile& rows, bench::Touching& body);

}  // namespace tick
