// Materials of the regions of a mesh.
#pragma once

#include <palpate/concepts/material.hpp>

#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// One material per region, by name; the name `everywhere` applies to all regions that are not named.
template <Material M>
using RegionMaterials = std::vector<std::pair<std::string, M>>;

}}  // namespace palpate
