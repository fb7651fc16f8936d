// Linear tetrahedra without condensation.
#include "linear.hpp"

namespace tradeoff {

void add_tet4_uncondensed(const Bench& bench, std::vector<Entry>& entries) {
  const std::string surface(surface_group);
  for (const char* mesh : {"given", "near", "all"})
    entries.push_back(linear_entry<Tet4, SparseCholesky>(bench, "Tet4", "SparseCholesky", mesh, surface));
  entries.push_back(linear_entry<Tet4, SparseCholesky>(bench, "Tet4", "SparseCholesky", "given", surface,
                                                       {.columns = ColumnFill::ahead}));
  entries.push_back(linear_entry<Tet4, ConjugateGradient>(bench, "Tet4", "ConjugateGradient", "given", surface));
}

}  // namespace tradeoff
