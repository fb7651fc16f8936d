// Moving neo-Hookean tissue by implicit steps with a factorisation.
#include <palpate/material/neo_hookean.hpp>

#include "soft.hpp"

namespace tradeoff {

void add_soft(const Bench& bench, std::vector<Entry>& entries) {
  const auto add = [&]<class E>(const char* element, const char* mesh, double step, int iterations, TimeScheme scheme,
                                const char* scheme_name) {
    ImplicitParameters parameters{.step = step, .scheme = scheme, .mass_damping = rest_damping};
    parameters.newton.maximum_iterations = iterations;
    const std::string work = number(1e3 * step) + " ms, " + std::to_string(iterations) + " iterations" + scheme_name;
    entries.push_back(soft_entry<E, NeoHookean, Implicit<Newton>>(
        bench, element, "neo-Hookean", "Implicit<Newton>", mesh, "double", work, parameters,
        "using Model = HapticFEModel<" + std::string(element) + ", NeoHookean, Implicit<Newton>>;   // with {.step = " +
            number(step) + ", .mass_damping = " + number(rest_damping) +
            ", .newton = {.maximum_iterations = " + std::to_string(iterations) + "}}"));
  };
  const TimeScheme euler = TimeScheme::implicit_euler();
  // A time step as long as the duration of an update keeps real time; shorter ones are slower than real time.
  add.operator()<Tet4>("Tet4", "given", 0.250, 2, euler, "");
  add.operator()<Tet4>("Tet4", "given", 0.040, 2, euler, "");
  if (!bench.full) return;
  add.operator()<Tet4>("Tet4", "given", 0.010, 1, euler, "");
  add.operator()<Tet4>("Tet4", "given", 0.010, 2, euler, "");
  add.operator()<Tet4>("Tet4", "given", 0.010, 2, TimeScheme::newmark(), ", Newmark");
  add.operator()<Tet4>("Tet4", "near", 0.040, 2, euler, "");
  add.operator()<Tet10>("Tet10", "given", 0.040, 2, euler, "");
}

}  // namespace tradeoff
