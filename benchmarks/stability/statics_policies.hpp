// Policies that are compiled in separate files.
#pragma once

#include "statics_answer.hpp"

namespace maps {

Answer by_condensed(const StaticProblem& problem);
Answer by_condensed_float(const StaticProblem& problem);
Answer by_condensed_gradients(const StaticProblem& problem);

}  // namespace maps
