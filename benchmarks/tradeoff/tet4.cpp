// Linear tetrahedra, condensed.
#include "linear.hpp"

namespace tradeoff {

void add_tet4(const Bench& bench, std::vector<Entry>& entries) {
  const std::string surface(surface_group);
  const auto add = [&]<class Policy>(const char* policy, const char* mesh, const std::string& kept) {
    entries.push_back(linear_entry<Tet4, Policy>(bench, "Tet4", policy, mesh, kept));
  };
  for (const std::string& kept : {near_group, wide_group, surface})
    add.operator()<Condensed<SelectiveInverse>>("Condensed<SelectiveInverse>", "given", kept);
  for (const char* mesh : {"near", "all"})
    add.operator()<Condensed<SelectiveInverse>>("Condensed<SelectiveInverse>", mesh, near_group);
  for (const char* mesh : {"given", "near", "all"})
    add.operator()<Condensed<SelectiveInverseFloat>>("Condensed<SelectiveInverseFloat>", mesh, near_group);
  add.operator()<Condensed<SelectiveInverseFloat>>("Condensed<SelectiveInverseFloat>", "given", surface);
}

}  // namespace tradeoff
