#include "statics_policies.hpp"

namespace maps {

Answer by_condensed(const StaticProblem& problem) {
  return answer_of<Condensed<SelectiveInverse>>(problem);
}
Answer by_condensed_float(const StaticProblem& problem) {
  return answer_of<Condensed<SelectiveInverseFloat>>(problem);
}
Answer by_condensed_gradients(const StaticProblem& problem) {
  return answer_of<Condensed<ConjugateGradient>>(problem);
}

}  // namespace maps
