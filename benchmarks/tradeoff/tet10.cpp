// Quadratic tetrahedra.
#include "linear.hpp"

namespace tradeoff {

void add_tet10(const Bench& bench, std::vector<Entry>& entries) {
  const char* name = "Tet10";
  for (const std::string& kept : {near_group, wide_group})
    entries.push_back(
        linear_entry<Tet10, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", "given", kept));
  entries.push_back(
      linear_entry<Tet10, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", "near", near_group));
  if (bench.full)
    entries.push_back(linear_entry<Tet10, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>",
                                                                       "all", near_group));
}

}  // namespace tradeoff
