// The compositions of each source file.
#pragma once

#include "tissue.hpp"

#include <vector>

namespace cross {

using Compositions = std::vector<Composition>;

void add_static(Compositions& all);
void add_stiffening(Compositions& all);
void add_moving_tet4(Compositions& all);
void add_moving_smoothed(Compositions& all);
void add_moving_tet10(Compositions& all);
void add_moving_hex8(Compositions& all);
void add_moving_hex20(Compositions& all);
void add_cut(Compositions& all);
void add_cut_moving_tetrahedra(Compositions& all);
void add_cut_moving_hexahedra(Compositions& all);

}  // namespace cross
