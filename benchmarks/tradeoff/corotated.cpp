// Co-rotated tissue that moves without a factor, in fixed work.
#include "soft.hpp"

namespace tradeoff {

void add_corotated(const Bench& bench, std::vector<Entry>& entries) {
  const auto add = [&](const char* mesh, int iterations, double tolerance) {
    CorotatedTissue::Options options;
    options.motion.mass_damping = drag;
    options.motion.solve = {iterations, tolerance};
    const std::string work =
        tolerance > 0.0 ? "1 ms, to " + number(tolerance) : "1 ms, " + std::to_string(iterations) + " iterations";
    entries.push_back(soft_entry<CorotatedTissue, Tet4, Corotational<LinearElastic>>(
        bench, "Tet4", "co-rotated", "CorotatedTissue", mesh, "float", work, options,
        "using Tissue = CorotatedTissue;   // of Mesh<Tet4>, Corotational<LinearElastic>, {.motion = {.mass_damping "
        "= " +
            number(drag) + ", .solve = {" + std::to_string(iterations) + ", " + number(tolerance) + "}}}"));
  };
  for (const int iterations : {1, 2, 4}) add("given", iterations, 0.0);
  add("given", 40, 3e-3);
  add("near", 40, 3e-3);
}

}  // namespace tradeoff
