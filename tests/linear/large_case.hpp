#pragma once

#include "linear/sparse_cases.hpp"

namespace test {

/// Promises three threads; its tasks run one after the other, the last one first.
struct OneByOne {
  int threads() const noexcept { return 3; }
  void run(int count, const ExecutorTask& task) const {
    for (int i = count - 1; i >= 0; --i) task(i);
  }
};

inline const SparseCase& large_case() {
  static const SparseCase c = [] {
    const Body<Tet4> body = body_of(box_tet4(Vector3(0.1, 0.1, 0.1), {14, 14, 14}), {liver});
    std::vector<NodeId> bottom;
    for (NodeId i = 0; i < body.mesh.node_count(); ++i)
      if (body.mesh.position(i)[2] < 1e-9) bottom.push_back(i);
    const EssentialConditions conditions = conditions_of(body.mesh, Scene().fix(bottom));
    SparseCase box{"box", free_matrix(assemble_stiffness<Tet4>(body, {}), conditions), {}};
    for (Index dof : conditions.free_dofs) box.layout.node_of_dof.push_back(dof / 3);
    box.layout.positions = body.mesh.positions;
    return box;
  }();
  return c;
}

}  // namespace test
