// Definitions of mechanisms.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/mechanisms.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline Index find_part(std::vector<Index>& parent, Index e) noexcept {
  const auto at = [&](Index i) -> Index& { return parent[static_cast<std::size_t>(i)]; };
  while (at(e) != e) e = at(e) = at(at(e));
  return e;
}

using MatrixRow = std::vector<double>;

inline double dot(const MatrixRow& a, const MatrixRow& b) noexcept {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
inline void subtract(MatrixRow& from, double factor, const MatrixRow& row) noexcept {
  for (std::size_t i = 0; i < from.size(); ++i) from[i] -= factor * row[i];
}

/// Orthonormal basis of the span of rows, by Gram-Schmidt with pivoting; a remainder of a row below `tolerance` is
/// treated as zero. O(rank x rows x columns).
inline std::vector<MatrixRow> row_space(std::vector<MatrixRow> rows, double tolerance) {
  std::vector<MatrixRow> basis;
  while (!rows.empty()) {
    const auto largest = std::ranges::max_element(rows, {}, [](const MatrixRow& r) { return dot(r, r); });
    MatrixRow row = *largest;
    std::swap(*largest, rows.back());
    rows.pop_back();
    for (const MatrixRow& b : basis) subtract(row, dot(b, row), b);
    const double length = std::sqrt(dot(row, row));
    if (!(length > tolerance)) break;
    for (double& x : row) x /= length;
    for (MatrixRow& r : rows) subtract(r, dot(row, r), row);
    basis.push_back(std::move(row));
  }
  return basis;
}

/// Rigid parts, the joints between them, and which parts are constrained.
class JointedParts {
 public:
  JointedParts(const MeshRef& mesh, const MeshParts& parts, std::span<const std::uint8_t> constrained,
               const Vector3& origin)
      : origin_(origin),
        constrained_(constrained.begin(), constrained.end()),
        parts_(static_cast<std::size_t>(parts.count)) {
    positions_.reserve(constrained_.size());
    for (Index i = 0; i < mesh.node_count; ++i)
      positions_.emplace_back(mesh.position(i)[0], mesh.position(i)[1], mesh.position(i)[2]);
    for (Index e = 0; e < mesh.element_count; ++e) {
      Part& part = parts_[static_cast<std::size_t>(parts.of_element[static_cast<std::size_t>(e)])];
      ++part.element_count;
      part.nodes.insert(part.nodes.end(), mesh.nodes_of(e), mesh.nodes_of(e + 1));
    }
    users_.resize(constrained_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      std::vector<NodeId>& nodes = parts_[p].nodes;
      std::ranges::sort(nodes);
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      for (const NodeId i : nodes) users_[static_cast<std::size_t>(i)].push_back(p);
    }
  }

  std::optional<Mechanism> find() {
    propagate_constraints();
    std::vector<char> seen(parts_.size(), 0);
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (!parts_[p].is_constrained && seen[p] == 0)
        if (auto found = find_in(cluster_of(p, seen))) return found;
    return std::nullopt;
  }

 private:
  struct Part {
    Index element_count = 0;
    std::vector<NodeId> nodes;
    RigidMotions motions;  ///< left free by the constraints and by constrained parts
    RigidFrame frame;
    bool is_constrained = false;
    std::size_t first = 0;  ///< its first unknown in its cluster
  };
  static constexpr std::size_t most_motions = 900;
  static constexpr double tolerance = 1e-6;

  /// A part that is fully constrained, by constraints or by other constrained parts, constrains its neighbours in turn.
  void propagate_constraints() {
    std::vector<std::size_t> pending(parts_.size()), next;
    std::iota(pending.begin(), pending.end(), std::size_t{0});
    for (; !pending.empty(); pending = std::exchange(next, {})) {
      std::ranges::sort(pending);
      pending.erase(std::unique(pending.begin(), pending.end()), pending.end());
      for (const std::size_t p : pending) {
        Part& part = parts_[p];
        if (part.is_constrained) continue;
        part.frame = RigidFrame(positions_, part.nodes, constrained_);
        part.motions = free_motions(positions_, part.nodes, constrained_, part.frame);
        if (part.motions.empty()) constrain(part, next);
      }
    }
  }
  void constrain(Part& part, std::vector<std::size_t>& neighbours) {
    part.is_constrained = true;
    for (const NodeId i : part.nodes) {
      constrained_[static_cast<std::size_t>(i)] = 7;
      for (const std::size_t q : users_[static_cast<std::size_t>(i)])
        if (!parts_[q].is_constrained) neighbours.push_back(q);
    }
  }

  bool is_free_joint(NodeId i) const noexcept {
    return users_[static_cast<std::size_t>(i)].size() > 1 && constrained_[static_cast<std::size_t>(i)] != 7;
  }

  /// The unconstrained parts that are connected to `first`, directly or through others.
  std::vector<std::size_t> cluster_of(std::size_t first, std::vector<char>& seen) const {
    std::vector<std::size_t> cluster{first};
    seen[first] = 1;
    for (std::size_t k = 0; k < cluster.size(); ++k)
      for (const NodeId i : parts_[cluster[k]].nodes) {
        if (!is_free_joint(i)) continue;
        for (const std::size_t q : users_[static_cast<std::size_t>(i)])
          if (std::exchange(seen[q], 1) == 0) cluster.push_back(q);
      }
    return cluster;
  }

  /// Motions of the cluster that keep its joints together: nothing, or the motions of its first part that can move. The
  /// unknowns are the amplitudes of every part's free motions.
  std::optional<Mechanism> find_in(const std::vector<std::size_t>& cluster) {
    std::size_t unknowns = 0;
    for (const std::size_t p : cluster) {
      parts_[p].first = unknowns;
      unknowns += parts_[p].motions.size();
    }
    if (unknowns > most_motions) return std::nullopt;
    double smallest = tolerance;
    for (const std::size_t p : cluster) smallest = std::max(smallest, parts_[p].frame.resolution);
    const std::vector<MatrixRow> basis = row_space(joint_rows(cluster, unknowns), smallest);
    if (basis.size() == unknowns) return std::nullopt;
    for (const std::size_t p : cluster)
      if (const RigidMotions motions = motions_left(parts_[p], basis); !motions.empty())
        return describe(parts_[p], motions);
    return std::nullopt;
  }

  /// Equations of the joints: at every joint the displacements of two parts are equal.
  std::vector<MatrixRow> joint_rows(const std::vector<std::size_t>& cluster, std::size_t unknowns) const {
    std::vector<MatrixRow> rows;
    for (const std::size_t p : cluster)
      for (const NodeId i : parts_[p].nodes) {
        const std::vector<std::size_t>& users = users_[static_cast<std::size_t>(i)];
        if (!is_free_joint(i) || users.front() == p) continue;
        for (int axis = 0; axis < 3; ++axis) {
          if ((constrained_[static_cast<std::size_t>(i)] >> axis & 1u) != 0) continue;
          MatrixRow row(unknowns, 0.0);
          add_displacement(parts_[users.front()], i, axis, 1.0, row);
          add_displacement(parts_[p], i, axis, -1.0, row);
          rows.push_back(std::move(row));
        }
      }
    return rows;
  }
  void add_displacement(const Part& part, NodeId node, int axis, double factor, MatrixRow& row) const {
    const Vector3 x = (positions_[static_cast<std::size_t>(node)] - part.frame.centre) / part.frame.size;
    const Vector6 at = constraint_row(x, axis);
    for (std::size_t k = 0; k < part.motions.size(); ++k)
      for (int c = 0; c < 6; ++c) row[part.first + k] += factor * at[c] * part.motions[k][c];
  }

  /// A part's motions in the complement of the joints' row space.
  static RigidMotions motions_left(const Part& part, const std::vector<MatrixRow>& basis) {
    const std::size_t n = part.motions.size();
    std::vector<MatrixRow> projector(n, MatrixRow(n, 0.0));  // on the remaining motions, restricted to this part
    for (std::size_t i = 0; i < n; ++i) {
      projector[i][i] = 1.0;
      for (const MatrixRow& b : basis)
        for (std::size_t j = 0; j < n; ++j) projector[i][j] -= b[part.first + i] * b[part.first + j];
    }
    RigidMotions left;
    for (const MatrixRow& amounts : row_space(std::move(projector), tolerance)) {
      Vector6 motion = Vector6::Zero();
      for (std::size_t k = 0; k < n; ++k) motion += amounts[k] * part.motions[k];
      left.push_back(motion);
    }
    return left;
  }

  Mechanism describe(const Part& part, const RigidMotions& motions) const {
    Mechanism m{part.element_count, {}, {}};
    for (const NodeId i : part.nodes)
      if (users_[static_cast<std::size_t>(i)].size() > 1) m.joints.push_back(i);
    m.modes = name_rigid_motions(motions, origin_ + part.frame.centre, part.frame.size);
    return m;
  }

  Vector3 origin_;
  std::vector<Vector3> positions_;
  std::vector<std::uint8_t>
      constrained_;  ///< per node: displacement components that are prescribed or fixed by a constrained part
  std::vector<Part> parts_;
  std::vector<std::vector<std::size_t>> users_;  ///< parts of every node, ascending
};

PALPATE_INLINE MeshParts face_connected_parts(const MeshRef& mesh) {
  const SortedFaces faces = sorted_faces(mesh);
  std::vector<Index> parent(static_cast<std::size_t>(mesh.element_count));
  std::iota(parent.begin(), parent.end(), Index{0});
  for (Index i = 1; i < faces.count(); ++i) {
    if (!std::equal(faces.key(i), faces.key(i) + faces.width, faces.key(i - 1))) continue;
    const Index a = find_part(parent, faces.element(i - 1)), b = find_part(parent, faces.element(i));
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  MeshParts parts{std::vector<Index>(parent.size(), -1), 0};
  for (std::size_t e = 0; e < parent.size(); ++e) {
    const auto root = static_cast<std::size_t>(find_part(parent, static_cast<Index>(e)));
    parts.of_element[e] = root == e ? parts.count++ : parts.of_element[root];
  }
  return parts;
}

PALPATE_INLINE std::optional<Mechanism> find_mechanism(const MeshRef& mesh, std::span<const std::uint8_t> constrained,
                                                       const Vector3& origin) {
  if (static_cast<Index>(constrained.size()) != mesh.node_count)
    raise(SetupErrorKind::bad_argument, "positions and constraints have different lengths",
          "Give one of each per node");
  const MeshParts parts = face_connected_parts(mesh);
  if (parts.count == connected_components(mesh).count) return std::nullopt;
  return JointedParts(mesh, parts, constrained, origin).find();
}

PALPATE_INLINE void require_no_mechanism(const MeshRef& mesh, std::span<const std::uint8_t> constrained,
                                         const Vector3& origin) {
  const std::optional<Mechanism> found = find_mechanism(mesh, constrained, origin);
  if (!found) return;
  const std::size_t count = found->modes.size();
  SetupProblem p;
  p.kind = SetupErrorKind::unconstrained;
  p.what = "a part of " + std::to_string(found->element_count) + " elements shares no face with others, only " +
           std::to_string(found->joints.size()) + (found->joints.size() == 1 ? " node" : " nodes") + ", and has " +
           std::to_string(count) + (count == 1 ? " free rigid motion:" : " free rigid motions:");
  for (std::size_t i = 0; i < count; ++i) p.what += (i == 0 ? " " : ", ") + found->modes[i];
  p.hint =
      "Join it to its neighbours by faces of elements, constrain it, or remove it; the ids are the nodes of the joint";
  p.set_ids(std::vector<std::int64_t>(found->joints.begin(), found->joints.end()), SetupIds::nodes);
  p.value = static_cast<double>(count);
  raise(std::move(p));
}

}}}  // namespace palpate::detail
