// Fully converged contact of spheres with linear tissue, for references.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/condensation/static_systems.hpp>
#include <palpate/linear/detail/indexed_vector.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/static/detail/solver_recipe.hpp>

#include <algorithm>

#include "push_apart.hpp"
#include "scene.hpp"

namespace tradeoff {

/// Forces on the spheres [N], displacement of the nodes of the given mesh [m].
struct Pressed {
  std::vector<Vector3> force;
  VectorX displacement;
};

/// Throws not_converged when the support forces do not balance the forces of the spheres.
inline void require_balance(const Pressed& pressed, Vector3 support, double depth) {
  double largest = 0.0;
  for (const Vector3& f : pressed.force) {
    support -= f;
    largest = std::max(largest, f.norm());
  }
  if (!(support.norm() < 1e-4 * largest))
    raise(SetupErrorKind::not_converged, "the reference is not in equilibrium at a depth of " + number(depth) +
                                             " m: relative error of support forces " +
                                             number(support.norm() / largest));
}

/// Linear tissue and rigid spheres: forces along the normals keep nodes outside the spheres, exactly, with the
/// compliance of the pressed nodes. One factorisation.
template <class E>
class LinearPress {
 public:
  LinearPress(const PressScene& scene, const Mesh<E>& mesh)
      : scene_(scene),
        mesh_(mesh),
        conditions_(resolve_essential(mesh, extract_boundary<E>(mesh), scene.scene(near_group))),
        stiffness_(assemble_stiffness<E>(make_body(mesh, scene.materials), {})),
        load_(conditions_.free_count()),
        answer_(conditions_.free_count()) {
    DofLayout layout{{}, mesh.positions, {}};
    for (const Index dof : conditions_.free_dofs) layout.node_of_dof.push_back(dof / 3);
    for (const NodeId node : mesh.find_group(near_group)->nodes) {
      if (conditions_.is_constrained(3 * Index{node})) continue;
      nodes_.push_back(node);
      for (int c = 0; c < 3; ++c)
        layout.kept.push_back(conditions_.free_index[static_cast<std::size_t>(3 * Index{node} + c)]);
    }
    solver_ = SolverTraits<Condensed<SelectiveInverse>>::make(stiffness_, conditions_, layout, {});
    columns_.resize(nodes_.size());
    force_.assign(nodes_.size(), Vector3::Zero());
  }

  Pressed at(double depth) {
    const std::vector<Vector3> centres = scene_.centres(depth);
    Pressed pressed{std::vector<Vector3>(centres.size()), {}};
    double change = infinity;
    for (int round = 0; change > 1e-5; ++round) {
      if (round == 300)
        raise(SetupErrorKind::not_converged, "the contact forces of the linear reference do not converge");
      const std::vector<Vector3> before = pressed.force;
      push(centres, pressed.force);
      change = 0.0;
      for (std::size_t b = 0; b < before.size(); ++b)
        change = std::max(change, (pressed.force[b] - before[b]).norm() / pressed.force[b].norm());
    }
    VectorX force = VectorX::Zero(conditions_.dof_count()), u(force.size()), answer(force.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) force.segment<3>(3 * Index{nodes_[i]}) = force_[i];
    solve(force, u);
    stiffness_.apply(u, answer);
    Vector3 support = Vector3::Zero();
    for (Index dof = 0; dof < answer.size(); ++dof)
      if (conditions_.is_constrained(dof)) support[dof % 3] += answer[dof];
    pressed.displacement = u.head(3 * scene_.mesh.node_count());
    require_balance(pressed, support, depth);
    return pressed;
  }

 private:
  struct Row {
    std::size_t node, sphere;
    Vector3 normal;
    double gap;
  };

  void solve(const VectorX& force, VectorX& u) {
    conditions_.gather(force, load_);
    solver_.solve_into(load_, answer_);
    conditions_.scatter(answer_, u);
  }
  /// Displacements of the touchable nodes per unit force on one of them [m/N].
  const Eigen::Matrix<double, Eigen::Dynamic, 3>& column(std::size_t i) {
    auto& c = columns_[i];
    if (c.rows() > 0) return c;
    c.resize(3 * static_cast<Index>(nodes_.size()), 3);
    VectorX response(c.rows());
    for (int k = 0; k < 3; ++k) {
      solver_.compliance_column(3 * static_cast<Index>(i) + k, response);
      c.col(k) = response;
    }
    return c;
  }
  Vector3 moved(std::size_t node) {
    Vector3 u = Vector3::Zero();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!force_[i].isZero(0.0)) u += column(i).template middleRows<3>(3 * static_cast<Index>(node)) * force_[i];
    return u;
  }
  /// One linearisation of the distances at the present node positions, solved by projected Gauss-Seidel.
  void push(const std::vector<Vector3>& centres, std::vector<Vector3>& on_spheres) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Vector3 u = moved(i);
      for (std::size_t b = 0; b < centres.size(); ++b) {
        const Vector3 off = mesh_.position(nodes_[i]) + u - centres[b];
        if (off.norm() < scene_.radius * 1.02)
          rows.push_back({i, b, off.normalized(), off.norm() - scene_.radius - off.normalized().dot(u)});
      }
    }
    const auto n = static_cast<Index>(rows.size());
    MatrixX w(n, n);
    VectorX lambda(n), gap(n);
    for (Index j = 0; j < n; ++j) {
      const Row& from = rows[static_cast<std::size_t>(j)];
      const Eigen::Matrix<double, Eigen::Dynamic, 1> response = column(from.node) * from.normal;
      gap[j] = from.gap;
      lambda[j] = std::max(0.0, force_[from.node].dot(from.normal));
      for (Index i = 0; i < n; ++i) {
        const Row& to = rows[static_cast<std::size_t>(i)];
        w(i, j) = to.normal.dot(response.segment<3>(3 * static_cast<Index>(to.node)));
      }
    }
    push_apart(w, gap, lambda, {.sweeps = 3000, .tolerance = 1e-9});
    std::ranges::fill(force_, Vector3::Zero());
    std::ranges::fill(on_spheres, Vector3::Zero());
    for (Index i = 0; i < n; ++i) {
      const Row& row = rows[static_cast<std::size_t>(i)];
      force_[row.node] += lambda[i] * row.normal;
      on_spheres[row.sphere] -= lambda[i] * row.normal;
    }
  }

  const PressScene& scene_;
  const Mesh<E>& mesh_;
  EssentialConditions conditions_;
  BlockMatrix stiffness_;
  CondensedSystem solver_;
  VectorX load_, answer_;
  std::vector<NodeId> nodes_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3>> columns_;
  std::vector<Vector3> force_;
};

}  // namespace tradeoff
