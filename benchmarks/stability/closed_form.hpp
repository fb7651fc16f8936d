// The linear tetrahedron by cross products in any precision, independent of the library's formulas.
#pragma once

#include "statics.hpp"

#include <Eigen/Geometry>

namespace maps {

/// Calls add(row, column, value) for every entry of the stiffness between free dofs.
template <class Real, class Add>
void add_stiffness(const StaticProblem& problem, const std::vector<Index>& free_index, Add add) {
  using Point = Eigen::Matrix<Real, 3, 1>;
  for (Index e = 0; e < problem.mesh.element_count(); ++e) {
    const auto& nodes = problem.mesh.elements[static_cast<std::size_t>(e)];
    const LinearElastic& m = problem.materials[static_cast<std::size_t>(problem.mesh.region(e))];
    const Real young = static_cast<Real>(m.youngs_modulus), nu = static_cast<Real>(m.poisson_ratio);
    const Real lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), mu = young / (2 * (1 + nu));
    std::array<Point, 3> edge;
    for (std::size_t i = 0; i < 3; ++i)
      edge[i] = problem.mesh.position(nodes[i + 1]).template cast<Real>() -
                problem.mesh.position(nodes[0]).template cast<Real>();
    const Real six_volumes = edge[0].dot(edge[1].cross(edge[2]));
    std::array<Point, 4> g;
    for (std::size_t i = 0; i < 3; ++i) g[i + 1] = edge[(i + 1) % 3].cross(edge[(i + 2) % 3]) / six_volumes;
    g[0] = -(g[1] + g[2] + g[3]);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            const Index row = free_index[static_cast<std::size_t>(3 * nodes[a] + i)],
                        column = free_index[static_cast<std::size_t>(3 * nodes[b] + j)];
            if (row < 0 || column < 0) continue;
            const Real shear = i == j ? mu * g[a].dot(g[b]) : Real(0);
            add(row, column, six_volumes / 6 * (lambda * g[a][i] * g[b][j] + mu * g[a][j] * g[b][i] + shear));
          }
  }
}

/// Index of every free dof, -1 where constrained, and the number of free dofs.
inline std::pair<std::vector<Index>, Index> free_dofs(const StaticProblem& problem) {
  std::vector<Index> index(3 * problem.mesh.positions.size(), 0);
  for (NodeId node : problem.constrained)
    for (int c = 0; c < 3; ++c) index[static_cast<std::size_t>(3 * node + c)] = -1;
  Index count = 0;
  for (Index& i : index)
    if (i == 0) i = count++;
  return {std::move(index), count};
}

inline VectorX load_of(const StaticProblem& problem, const std::vector<Index>& free_index, Index count) {
  VectorX load = VectorX::Zero(count);
  for (NodeId node : problem.pulled)
    for (int c = 0; c < 3; ++c)
      if (const Index i = free_index[static_cast<std::size_t>(3 * node + c)]; i >= 0)
        load[i] += problem.force[c] / static_cast<double>(problem.pulled.size());
  return load;
}

/// Values of free dofs on all dofs: 3 per node, zero where constrained.
inline VectorX spread(const VectorX& free, const std::vector<Index>& free_index) {
  VectorX all = VectorX::Zero(static_cast<Index>(free_index.size()));
  for (std::size_t dof = 0; dof < free_index.size(); ++dof)
    if (free_index[dof] >= 0) all[static_cast<Index>(dof)] = free[free_index[dof]];
  return all;
}

}  // namespace maps
