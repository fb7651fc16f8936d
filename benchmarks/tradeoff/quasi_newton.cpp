// Moving neo-Hookean tissue by a quasi-Newton method around one factor.
#include <palpate/material/neo_hookean.hpp>

#include "soft.hpp"

namespace tradeoff {

void add_quasi_newton(const Bench& bench, std::vector<Entry>& entries) {
  const auto add = [&]<class E, class S>(const char* element, const char* mesh, const char* scalar,
                                         const QuasiNewtonParameters& parameters) {
    const std::string solver = "Implicit<QuasiNewton<" + std::string(scalar) + ">>", step = number(parameters.step);
    std::string given = parameters.inertia ? ".mass_damping = " + number(parameters.mass_damping) : ".inertia = false";
    std::string work = number(1e3 * parameters.step) + (parameters.inertia ? " ms" : " ms, no inertia");
    if (parameters.large_strain_within < infinity) {
      given += ", .large_strain_within = " + number(parameters.large_strain_within);
      work += ", large strain within " + number(1e3 * parameters.large_strain_within) + " mm";
    }
    if (parameters.renew_factor) {
      given += ", .renew_factor = true";
      work += ", renewed factor (second thread)";
    }
    entries.push_back(soft_entry<E, NeoHookean, Implicit<QuasiNewton<S>>>(
        bench, element, "neo-Hookean", solver, mesh, scalar, work, parameters,
        "using Model = HapticFEModel<" + std::string(element) + ", NeoHookean, " + solver +
            ">;   // with {.step = " + step + ", " + given + "}"));
  };
  const char* smoothed = "Smoothed<Tet4>";
  const QuasiNewtonParameters slow{.inertia = false}, swinging{.mass_damping = rest_damping};
  add.operator()<Smoothed<Tet4>, float>(smoothed, "given", "float", slow);
  add.operator()<Smoothed<Tet4>, double>(smoothed, "given", "double", slow);
  for (const double radii : {1.0, 2.0, 4.0, infinity})
    for (const bool renew : {false, true}) {
      QuasiNewtonParameters near = slow;
      near.large_strain_within = radii * bench.scene.radius;
      near.renew_factor = renew;
      add.operator()<Smoothed<Tet4>, float>(smoothed, "near", "float", near);
    }
  add.operator()<Smoothed<Tet4>, float>(smoothed, "given", "float", swinging);
  add.operator()<Tet4, double>("Tet4", "given", "double", slow);
  if (!bench.full) return;
  add.operator()<Smoothed<Tet4>, double>(smoothed, "near", "double", slow);
  add.operator()<Smoothed<Tet4>, float>(smoothed, "near", "float", swinging);
  add.operator()<Tet10, double>("Tet10", "given", "double", slow);
}

}  // namespace tradeoff
