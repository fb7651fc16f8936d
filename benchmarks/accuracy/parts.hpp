// The comparisons of the program.
#pragma once

#include "report.hpp"

#include <string>

namespace accuracy {

/// Oracle cases: displacement compared with that of other codes.
void compare_with_oracle(const std::string& folder, Checks& checks);
/// A smooth manufactured solution: errors and orders on refined meshes, even and distorted. Writes `picture` (SVG).
void manufactured_solution(const std::string& picture, Checks& checks);
/// Lame's sphere, a cantilever, Cook's membrane, NAFEMS LE10.
void benchmark_problems(Checks& checks);
/// Poisson's ratio from 0.3 to 0.4999: displacement and force of plain and treated elements.
void locking(Checks& checks);

}  // namespace accuracy
