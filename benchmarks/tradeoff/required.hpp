// What it costs to keep more of a body than a scene requires.
#pragma once

#include "contender.hpp"

namespace tradeoff {

/// Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse> on the mesh as given, touchable where a group says.
std::unique_ptr<Contender> make_condensed(const Bench& bench, const std::string& touched);

/// Set-up, memory, tick and recovery of all nodes over the number of touched nodes, from 10 to the whole surface;
/// required.csv and required.md in `out`. False when the force depends on what else is kept, which it must not.
bool measure_required(Bench& bench, const std::string& out);

}  // namespace tradeoff
