// Moving neo-Hookean tissue by a quasi-Newton method around one factor.
#include <palpate/material/neo_hookean.hpp>

#include "soft.hpp"

namespace tradeoff {

void add_quasi_newton(const Bench& bench, std::vector<Entry>& entries) {
  const auto add = [&]<class E, class S>(const char* element, const char* mesh, const char* scalar,
                                         const QuasiNewtonParameters& parameters) {
    const std::string solver = "Implicit<QuasiNewton<" + std::string(scalar) + ">>", step = number(parameters.step);
    const std::string given =
        parameters.inertia ? ".mass_damping = " + number(parameters.mass_damping) : ".inertia = false";
    entries.push_back(soft_entry<E, NeoHookean, Implicit<QuasiNewton<S>>>(
        bench, element, "neo-Hookean", solver, mesh, scalar,
        number(1e3 * parameters.step) + (parameters.inertia ? " ms" : " ms, no inertia"), parameters,
        "using Model = HapticFEModel<" + std::string(element) + ", NeoHookean, " + solver +
            ">;   // with {.step = " + step + ", " + given + "}"));
  };
  const char* smoothed = "Smoothed<Tet4>";
  const QuasiNewtonParameters slow{.inertia = false}, swinging{.mass_damping = rest_damping};
  add.operator()<Smoothed<Tet4>, float>(smoothed, "given", "float", slow);
  add.operator()<Smoothed<Tet4>, double>(smoothed, "given", "double", slow);
  add.operator()<Smoothed<Tet4>, float>(smoothed, "near", "float", slow);
  add.operator()<Smoothed<Tet4>, float>(smoothed, "given", "float", swinging);
  add.operator()<Tet4, double>("Tet4", "given", "double", slow);
  if (!bench.full) return;
  add.operator()<Smoothed<Tet4>, double>(smoothed, "near", "double", slow);
  add.operator()<Smoothed<Tet4>, float>(smoothed, "near", "float", swinging);
  add.operator()<Tet10, double>("Tet10", "given", "double", slow);
}

}  // namespace tradeoff
