// The reference without its short cut.
#pragma once

#include "reference.hpp"

namespace tradeoff {

/// As make_reference, with large strain solved on the fine mesh itself: a quarter of an hour instead of a minute.
Reference make_direct_reference(const PressScene& scene, double edge);

}  // namespace tradeoff
