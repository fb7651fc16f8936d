// Quadratic tetrahedra.
#include "linear.hpp"

namespace tradeoff {

void add_tet10(const Bench& bench, std::vector<Entry>& entries) {
  const char* name = "Tet10";
  const auto add = [&](const char* mesh, const std::string& kept) {
    entries.push_back(
        linear_entry<Tet10, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", mesh, kept));
  };
  add("given", near_group);
  add("near", near_group);
  if (!bench.full) return;
  add("given", wide_group);
  add("all", near_group);
}

}  // namespace tradeoff
