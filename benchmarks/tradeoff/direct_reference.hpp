// The reference without approximation.
#pragma once

#include "reference.hpp"

namespace tradeoff {

/// Like make_reference, but solves large strain on the fine mesh itself: takes some five minutes instead of one.
Reference make_direct_reference(const PressScene& scene, double edge);

}  // namespace tradeoff
