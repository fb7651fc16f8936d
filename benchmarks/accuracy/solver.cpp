// The direct solver, compiled once for all elements.
#include "statics.hpp"

#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <chrono>

namespace accuracy {

VectorX solve_free(const BlockMatrix& k, const EssentialConditions& conditions, const std::vector<Vector3>& positions,
                   const VectorX& load, double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  DofLayout layout{{}, positions, {}};
  for (const Index dof : conditions.free_dofs) layout.node_of_dof.push_back(dof / 3);
  const SparseMatrix lower = free_matrix(k, conditions);
  SparseCholesky solver(detail::CholeskyAnalysis(lower, layout), lower, {});
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  VectorX free(conditions.free_count()), answer(conditions.free_count()), full(load.size());
  conditions.gather(load, free);
  solver.solve_into(free, answer);
  conditions.scatter(answer, full);
  return full;
}

}  // namespace accuracy
