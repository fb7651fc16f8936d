#include "statics_policies.hpp"

namespace maps {

std::vector<StaticSolver> our_solvers() {
  return {{"SparseCholesky", true, 1e-5, answer_of<SparseCholesky>},
          {"Condensed<SelectiveInverse>", true, 1e-5, by_condensed},
          {"Condensed<SelectiveInverseFloat>", true, 1e-3, by_condensed_float},
          {"ConjugateGradient", true, 1e-5, answer_of<ConjugateGradient>},
          {"Condensed<ConjugateGradient>", true, 1e-5, by_condensed_gradients}};
}

}  // namespace maps
