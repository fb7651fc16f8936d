#pragma once

#include "linear/systems.hpp"

#include <palpate/linear/sparse_cholesky.hpp>

namespace test {

/// A positive definite matrix with optional information about its dofs.
struct SparseCase {
  std::string name;
  SparseMatrix lower;
  DofLayout layout;
};

/// A constrained sphere with coordinates.
inline SparseCase sphere_case(int refinement) {
  const Body<Tet4> body = body_of(sphere_tet4(0.05, refinement), {liver});
  std::vector<NodeId> below;
  for (NodeId i = 0; i < body.mesh.node_count(); ++i)
    if (body.mesh.position(i)[2] < -0.02) below.push_back(i);
  const EssentialConditions conditions = conditions_of(body.mesh, Scene().fix(below));
  SparseCase c{"sphere " + std::to_string(refinement), free_matrix(assemble_stiffness<Tet4>(body, {}), conditions), {}};
  for (Index dof : conditions.free_dofs) c.layout.node_of_dof.push_back(dof / 3);
  c.layout.positions = body.mesh.positions;
  return c;
}

/// Diagonally dominant with the given off-diagonal pairs and random values.
inline SparseMatrix dominant(Index n, const std::vector<std::array<Index, 2>>& pairs) {
  testing::Random random(static_cast<std::uint64_t>(n) + pairs.size());
  MatrixX m = MatrixX::Zero(n, n);
  for (const auto& [i, j] : pairs)
    if (i != j) m(std::max(i, j), std::min(i, j)) = random.uniform(-1.0, 1.0);
  const MatrixX both = m + m.transpose();
  m.diagonal() = both.cwiseAbs().rowwise().sum().array() + 0.1 + VectorX::Random(n).array().abs();
  return SparseMatrix(m.sparseView());
}

inline std::vector<SparseCase> sparse_cases() {
  std::vector<SparseCase> cases;
  const auto add = [&](std::string name, SparseMatrix lower) {
    cases.push_back({std::move(name), std::move(lower), {}});
  };
  add("empty", SparseMatrix(0, 0));
  add("one", dominant(1, {}));
  add("diagonal", dominant(50, {}));
  std::vector<std::array<Index, 2>> chain, arrow, dense, islands, random_pairs;
  for (Index i = 1; i < 150; ++i) chain.push_back({i - 1, i});
  for (Index i = 1; i < 200; ++i) arrow.push_back({0, i});
  for (Index i = 0; i < 60; ++i)
    for (Index j = 0; j < i; ++j) dense.push_back({i, j});
  for (Index i = 0; i < 200; ++i)
    for (Index j = i / 10 * 10; j < i; ++j) islands.push_back({i, j});
  testing::Random random(3);
  for (int i = 0; i < 400; ++i)
    random_pairs.push_back({static_cast<Index>(random.uniform(0, 180)), static_cast<Index>(random.uniform(0, 180))});
  add("chain", dominant(150, chain));
  add("arrow", dominant(200, arrow));
  add("dense", dominant(60, dense));
  add("islands", dominant(200, islands));
  add("random", dominant(180, random_pairs));
  add("large dense", lower_half(with_condition(333, 1e3)));
  cases.push_back(sphere_case(1));
  cases.push_back(sphere_case(4));
  add("sphere without coordinates", sphere_stiffness(4));
  SparseCase partly = sphere_case(3);  // some nodes keep only one or two dofs
  partly.name = "nodes of 1 to 3 dofs";
  MatrixX m = full(partly.lower);
  std::vector<Index> stay;
  for (Index i = 0; i < m.rows(); ++i)
    if (i % 5 != 0 && i % 7 != 1) stay.push_back(i);
  MatrixX less(stay.size(), stay.size());
  std::vector<Index> nodes;
  for (std::size_t i = 0; i < stay.size(); ++i) {
    nodes.push_back(partly.layout.node_of_dof[static_cast<std::size_t>(stay[i])]);
    for (std::size_t j = 0; j < stay.size(); ++j)
      less(static_cast<Index>(i), static_cast<Index>(j)) = m(stay[i], stay[j]);
  }
  partly.lower = lower_half(less);
  partly.layout.node_of_dof = nodes;
  cases.push_back(partly);
  SparseCase line = sphere_case(4);  // all nodes at one position: the coordinates give no order
  line.name = "coincident coordinates";
  for (Vector3& x : line.layout.positions) x.setZero();
  cases.push_back(line);
  return cases;
}

}  // namespace test
