// The bodies that are measured: the standard block, and bodies of irregular shape.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>

namespace bench {

using namespace palpate;

inline constexpr LinearElastic tissue{.youngs_modulus = 10e3, .poisson_ratio = 0.45, .density = 1000.0};

/// Ids of all nodes for which wanted(position) is true.
template <class Wanted>
std::vector<NodeId> nodes_where(const Mesh<Tet4>& mesh, Wanted wanted) {
  std::vector<NodeId> nodes;
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if (wanted(mesh.position(i))) nodes.push_back(i);
  return nodes;
}

/// A mesh with its constrained and its touchable nodes.
struct SupportedBody {
  Mesh<Tet4> mesh;
  std::vector<NodeId> constrained, touched;

  Scene scene() const {
    Scene s;
    s.fix(constrained).touch(touched);
    return s;
  }
  Body<Tet4> body() const {
    const std::size_t regions = mesh.region_names.size();
    return {mesh, std::vector<Matrix6>(regions, tissue.elasticity()), std::vector<double>(regions, tissue.density),
            std::vector<Vector6>(regions, Vector6::Zero())};
  }
};

/// Cube of 0.1 m in n x n x n cells of six tetrahedra, constrained at the bottom. Touchable is a square patch in the
/// middle of the top with an odd number of nodes per side: 7 x 7 at n = 16, 11 x 11 at n = 24.
inline SupportedBody standard_block(int n) {
  SupportedBody b{box_tet4(Vector3(0.1, 0.1, 0.1), {n, n, n}, BoxSplit::six), {}, {}};
  const double half = 0.1 / n * (n < 16 ? 2 : n < 24 ? 3 : n < 32 ? 5 : 7) + 1e-6;
  b.constrained = nodes_where(b.mesh, [](const Vector3& p) { return p.z() < 1e-9; });
  b.touched = nodes_where(b.mesh, [=](const Vector3& p) {
    return p.z() > 0.1 - 1e-9 && std::abs(p.x() - 0.05) <= half && std::abs(p.y() - 0.05) <= half;
  });
  return b;
}

/// The elements for which wanted(centre) is true, with their nodes.
template <class Wanted>
Mesh<Tet4> part_of(const Mesh<Tet4>& mesh, Wanted wanted) {
  Mesh<Tet4> part;
  std::vector<NodeId> fresh(mesh.positions.size(), -1);
  for (auto nodes : mesh.elements) {
    Vector3 centre = Vector3::Zero();
    for (NodeId i : nodes) centre += 0.25 * mesh.position(i);
    if (!wanted(centre)) continue;
    for (NodeId& i : nodes) {
      NodeId& id = fresh[static_cast<std::size_t>(i)];
      if (id < 0) {
        id = static_cast<NodeId>(part.positions.size());
        part.positions.push_back(mesh.position(i));
      }
      i = id;
    }
    part.elements.push_back(nodes);
  }
  return part;
}

/// A body like an organ: a sphere of `layers` layers, with element edges of about `edge` [m], a cavity inside and nodes
/// displaced at random. Constrained at the bottom; the 300 surface nodes nearest to the top are touchable.
inline SupportedBody organ_like(int layers, double edge) {
  const double radius = layers * edge;
  const Vector3 cavity = radius * Vector3(0.3, 0.1, -0.1);
  SupportedBody b{
      part_of(sphere_tet4(radius, layers), [&](const Vector3& c) { return (c - cavity).norm() > 0.35 * radius; }),
      {},
      {}};
  testing::Random random(7);
  for (Vector3& p : b.mesh.positions) p += edge * random.vector<3>(-0.1, 0.1);
  const Vector3 top(0.0, 0.0, radius);
  std::vector<NodeId> outer = nodes_where(b.mesh, [=](const Vector3& p) { return p.norm() > radius - 0.3 * edge; });
  std::ranges::sort(outer, {}, [&](NodeId i) { return (b.mesh.position(i) - top).squaredNorm(); });
  if (outer.size() > 300) outer.resize(300);
  std::erase_if(outer, [&](NodeId i) { return b.mesh.position(i).z() < -0.5 * radius; });
  b.touched = std::move(outer);
  b.constrained = nodes_where(b.mesh, [=](const Vector3& p) { return p.z() < -0.6 * radius; });
  return b;
}

/// Equations of a constrained body, and the layout of their dofs for the solver.
struct System {
  SparseMatrix lower;
  DofLayout layout;          ///< without kept dofs
  std::vector<Index> patch;  ///< free dofs of the touched nodes

  explicit System(const SupportedBody& supported) {
    Scene scene;
    scene.fix(supported.constrained);
    const auto conditions = resolve_essential(supported.mesh, extract_boundary<Tet4>(supported.mesh), scene);
    lower = free_matrix(assemble_stiffness<Tet4>(supported.body(), {}), conditions);
    layout.positions = supported.mesh.positions;
    for (Index dof : conditions.free_dofs) layout.node_of_dof.push_back(dof / 3);
    for (NodeId node : supported.touched)
      for (int c = 0; c < 3; ++c)
        if (const Index f = conditions.free_index[static_cast<std::size_t>(3 * Index{node} + c)]; f >= 0)
          patch.push_back(f);
  }
  DofLayout keeping_patch() const {
    DofLayout l = layout;
    l.kept = patch;
    return l;
  }
  double residual(const VectorX& x, const VectorX& b) const {
    return (b - lower.selfadjointView<Eigen::Lower>() * x).norm() / b.norm();
  }
};

/// Random numbers between -1 and 1, the same in every run.
inline MatrixX random_matrix(Index rows, Index columns) {
  testing::Random random(11);
  return MatrixX::NullaryExpr(rows, columns, [&] { return random.uniform(-1.0, 1.0); });
}

}  // namespace bench
