// Smoothed linear tetrahedra, which do not lock.
#include "linear.hpp"

namespace tradeoff {

void add_smoothed(const Bench& bench, std::vector<Entry>& entries) {
  using E = Smoothed<Tet4>;
  const char* name = "Smoothed<Tet4>";
  const std::string surface(surface_group);
  for (const std::string& kept : {near_group, wide_group, surface})
    entries.push_back(
        linear_entry<E, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", "given", kept));
  for (const char* mesh : {"near", "all"})
    if (bench.full || mesh == std::string("near"))
      entries.push_back(
          linear_entry<E, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", mesh, near_group));
}

}  // namespace tradeoff
