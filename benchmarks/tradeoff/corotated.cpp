// Moving co-rotated tissue without a factorisation, with a fixed amount of work.
#include "soft.hpp"

namespace tradeoff {

void add_corotated(const Bench& bench, std::vector<Entry>& entries) {
  const auto add = [&](const char* mesh, int iterations, double tolerance) {
    const CorotatedParameters parameters{.mass_damping = rest_damping, .solve = {iterations, tolerance}};
    const std::string work =
        tolerance > 0.0 ? "1 ms, to " + number(tolerance) : "1 ms, " + std::to_string(iterations) + " iterations";
    entries.push_back(soft_entry<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>(
        bench, "Tet4", "co-rotated", "Implicit<MatrixFreeCG>", mesh, "float", work, parameters,
        "using Model = HapticFEModel<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>;   // "
        "with {.mass_damping = " +
            number(rest_damping) + ", .solve = {" + std::to_string(iterations) + ", " + number(tolerance) + "}}"));
  };
  for (const int iterations : {1, 2, 4}) add("given", iterations, 0.0);
  add("given", 40, 3e-3);
  add("near", 40, 3e-3);
}

}  // namespace tradeoff
