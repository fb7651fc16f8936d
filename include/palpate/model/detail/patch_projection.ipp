// Definitions of patch_projection.hpp.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/model/detail/patch_projection.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE NodePatch::NodePatch(const HalfSpaceSource& source)
    : source_(source),
      element_seen_(static_cast<std::size_t>(source.mesh.element_count), 0),
      node_seen_(static_cast<std::size_t>(source.mesh.node_count), 0),
      side_seen_(node_seen_),
      place_(node_seen_.size(), -1) {}

PALPATE_INLINE bool NodePatch::faces_my_way(int triangle) const noexcept {
  constexpr double cosine = 0.5;
  return source_.boundary.triangle_normal(triangle).dot(normal_) > cosine;
}

PALPATE_INLINE void NodePatch::collect_elements() {
  nodes_.assign(1, middle_);
  node_seen_[static_cast<std::size_t>(middle_)] = search_;
  layer_end_.assign(1, 1);
  std::size_t next = 0;
  for (int layer = 0; layer < source_.layers; ++layer) {
    for (const std::size_t end = nodes_.size(); next < end; ++next)
      for (const NodeId e : source_.around.of(nodes_[next])) {
        if (std::exchange(element_seen_[static_cast<std::size_t>(e)], search_) == search_) continue;
        for (int a = 0; a < source_.mesh.element.nodes; ++a) {
          const NodeId n = source_.mesh.nodes_of(e)[a];
          if (std::exchange(node_seen_[static_cast<std::size_t>(n)], search_) != search_) nodes_.push_back(n);
        }
      }
    layer_end_.push_back(nodes_.size());
  }
}

PALPATE_INLINE void NodePatch::collect_side() {
  side_.assign(1, middle_);
  side_seen_[static_cast<std::size_t>(middle_)] = search_;
  std::size_t next = 0;
  for (int layer = 0; layer < source_.layers * source_.mesh.element.order; ++layer)
    for (const std::size_t end = side_.size(); next < end; ++next)
      for (const int t : source_.boundary.triangles_at(side_[next]))
        if (faces_my_way(t))
          for (const NodeId n : source_.boundary.triangle(t))
            if (std::exchange(side_seen_[static_cast<std::size_t>(n)], search_) != search_) side_.push_back(n);
}

PALPATE_INLINE bool NodePatch::is_complete(NodeId node) const noexcept {
  return std::ranges::all_of(source_.around.of(node),
                             [&](NodeId e) { return element_seen_[static_cast<std::size_t>(e)] == search_; });
}

PALPATE_INLINE bool NodePatch::may_move(NodeId node) const noexcept {
  if (node == middle_) return true;
  if (source_.constrained[static_cast<std::size_t>(node)] != 0) return false;
  const std::span<const int> triangles = source_.boundary.triangles_at(node);
  if (triangles.empty()) return true;
  return side_seen_[static_cast<std::size_t>(node)] == search_ &&
         std::ranges::all_of(triangles, [&](int t) { return faces_my_way(t); });
}

PALPATE_INLINE void NodePatch::find(NodeId middle, const Vector3& normal) {
  for (const NodeId n : free_) place_[static_cast<std::size_t>(n)] = -1;
  free_.clear();
  ++search_;
  middle_ = middle;
  normal_ = normal;
  collect_elements();
  collect_side();
  for (const NodeId n : nodes_)
    if (may_move(n) && is_complete(n)) {
      place_[static_cast<std::size_t>(n)] = static_cast<int>(free_.size());
      free_.push_back(n);
    }
  cut_ = false;
  for (const int t : source_.boundary.triangles_at(middle))
    for (const NodeId n : source_.boundary.triangle(t)) cut_ = cut_ || index_of(n) < 0;
}

PALPATE_INLINE HalfSpaceLoad::HalfSpaceLoad(const HalfSpaceSource& source) : source_(source) {}

PALPATE_INLINE bool HalfSpaceLoad::is_flat(const BoundaryFace& face) const noexcept {
  return std::all_of(face.nodes.begin(), face.nodes.end(),
                     [&](NodeId n) { return std::abs((source_.position(n) - middle_).dot(normal_)) <= tolerance_; });
}

/// Calls add(point, traction times area) for every point of a face.
template <class Nodes, class Add>
void HalfSpaceLoad::for_each_traction(const Nodes& nodes, const FaceRule& rule, Add&& add) const {
  for (const FacePoint& point : rule) {
    Vector3 x = Vector3::Zero(), u = x, v = x;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Vector3 p = source_.position(nodes[a]) - middle_;
      x += point.shape[a] * p;
      u += point.along_u[a] * p;
      v += point.along_v[a] * p;
    }
    add(point, field_->traction(x, point.weight * cross(u, v)));
  }
}

PALPATE_INLINE void HalfSpaceLoad::add_boundary_face(const BoundaryFace& face) {
  if (is_flat(face)) return;
  const FaceRules& rules = source_.rules.of(face.nodes.size());
  const auto own =
      static_cast<std::size_t>(std::find(face.nodes.begin(), face.nodes.end(), patch_->middle()) - face.nodes.begin());
  const bool has_middle = own < face.nodes.size();
  for_each_traction(face.nodes, has_middle ? rules.singular_at[own] : rules.smooth,
                    [&](const FacePoint& point, const Matrix3& f) {
                      for (std::size_t a = 0; a < face.nodes.size(); ++a) {
                        const int place = patch_->index_of(face.nodes[a]);
                        if (place < 0) continue;
                        const double share = a == own ? point.shape[a] - 1.0 : point.shape[a];
                        load_->block<3, 3>(3 * place, 0) += share * f;
                      }
                    });
}

PALPATE_INLINE void HalfSpaceLoad::add_own_load() {
  const ElementLayout& element = source_.mesh.element;
  auto load = load_->block<3, 3>(3 * patch_->index_of(patch_->middle()), 0);
  for (const NodeId e : source_.around.of(patch_->middle()))
    for (int f = 0; f < element.face_count; ++f) {
      ShortIds<static_cast<std::size_t>(max_face_nodes)> nodes(element.local_face(f).size());
      for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = source_.mesh.nodes_of(e)[element.local_face(f)[a]];
      if (std::find(nodes.begin(), nodes.end(), patch_->middle()) != nodes.end()) continue;
      for_each_traction(nodes, source_.rules.of(nodes.size()).near_singularity,
                        [&](const FacePoint&, const Matrix3& traction) { load -= traction; });
    }
}

PALPATE_INLINE void HalfSpaceLoad::compute(const NodePatch& patch, const HalfSpaceField& field, const Vector3& normal,
                                           MatrixX& load) {
  constexpr double flat = 1e-9;
  patch_ = &patch;
  field_ = &field;
  load_ = &load;
  middle_ = source_.position(patch.middle());
  normal_ = normal;
  tolerance_ = flat * source_.boundary.length(patch.middle());
  ++number_;
  load.setZero(3 * static_cast<Index>(patch.free().size()), 3);
  const auto own_faces = source_.boundary.faces_at(patch.middle());
  if (std::ranges::all_of(own_faces, [&](int f) { return is_flat(source_.boundary.face(f)); }))
    load.block<3, 3>(3 * patch.index_of(patch.middle()), 0).setIdentity();
  else
    add_own_load();
  for (const NodeId n : patch.free())
    for (const int f : source_.boundary.faces_at(n)) {
      if (static_cast<std::size_t>(f) >= face_seen_.size()) face_seen_.resize(static_cast<std::size_t>(f) + 1, 0);
      if (std::exchange(face_seen_[static_cast<std::size_t>(f)], number_) != number_)
        add_boundary_face(source_.boundary.face(f));
    }
}

PALPATE_INLINE ColumnBlocks::ColumnBlocks(const BlockPattern& pattern)
    : first_(static_cast<std::size_t>(pattern.rows()) + 1, 0) {
  const auto for_each = [&](auto&& visit) {
    for (Index row = 0; row < pattern.rows(); ++row)
      for (Index p = pattern.row_start[static_cast<std::size_t>(row)]; p < pattern.diagonal(row); ++p)
        visit(static_cast<NodeId>(row), static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(p)]), p);
  };
  for_each([&](NodeId, std::size_t column, Index) { ++first_[column + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  block_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for_each([&](NodeId row, std::size_t column, Index p) {
    block_[static_cast<std::size_t>(next[column]++)] = {row, p};
  });
}

PALPATE_INLINE PatchProjection::PatchProjection(const HalfSpaceSource& source, const ColumnBlocks& columns)
    : source_(source),
      columns_(columns),
      patch_(source),
      load_(source),
      known_(static_cast<std::size_t>(source.mesh.node_count), 0),
      value_of_(known_) {}

PALPATE_INLINE const Matrix3& PatchProjection::boundary_value(NodeId node, const HalfSpaceField& field) {
  const auto i = static_cast<std::size_t>(node);
  if (std::exchange(known_[i], number_) != number_) {
    value_of_[i] = static_cast<int>(values_.size());
    values_.push_back(field.displacement(source_.position(node) - source_.position(patch_.middle())));
  }
  return values_[static_cast<std::size_t>(value_of_[i])];
}

PALPATE_INLINE void PatchProjection::assemble(const UniformStiffness& stiffness, const HalfSpaceField& field) {
  const BlockMatrix& k = *stiffness.matrix;
  const BlockPattern& pattern = k.pattern();
  ++number_;
  values_.clear();
  const auto size = 3 * static_cast<Index>(patch_.free().size());
  matrix_.setZero(size, size);
  for (const NodeId row : patch_.free()) {
    const Index at = 3 * Index{patch_.index_of(row)};
    for (Index p = pattern.row_start[static_cast<std::size_t>(row)]; p <= pattern.diagonal(row); ++p) {
      const NodeId column = pattern.column[static_cast<std::size_t>(p)];
      const int to = patch_.index_of(column);
      const Matrix3 block = k.block(p);
      if (to < 0)
        right_.block<3, 3>(at, 0) -= block * boundary_value(column, field);
      else if (3 * to <= at)
        matrix_.block<3, 3>(at, 3 * to) = block;
      else
        matrix_.block<3, 3>(3 * to, at) = block.transpose();
    }
    for (const ColumnBlocks::Block& below : columns_.of(row))
      if (patch_.index_of(below.row) < 0) {
        const Matrix3 block = k.block(below.position).transpose();
        right_.block<3, 3>(at, 0) -= block * boundary_value(below.row, field);
      }
  }
}

/// A volume averaged around a node that is not free has few free nodes. Near incompressibility it is a constraint that
/// values of the field at nodes do not meet exactly, and there are about as many of those as free nodes: patches lock,
/// and forces on Smoothed<Tet4> were 9 to 18 % too low at nu = 0.4999. Such a domain keeps the bulk modulus of nu =
/// 0.497; what is above it acts with the known mean stress of the field: 1 to 4 %. Values for 0.495 to 0.4975 do the
/// same.
PALPATE_INLINE void PatchProjection::release_cut_domains(const UniformStiffness& stiffness,
                                                         const HalfSpaceField& field) {
  constexpr double kept_bulk = 150.0;  // per shear modulus
  if (source_.domains.empty()) return;
  const double nu = stiffness.poisson_ratio;
  const double bulk = 2.0 * stiffness.shear_modulus * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
  const double released = bulk - kept_bulk * stiffness.shear_modulus;
  if (!(released > 0.0)) return;
  for (const NodeId n : patch_.nodes()) {
    if (patch_.index_of(n) >= 0) continue;
    const Vector3 offset = source_.position(n) - source_.position(patch_.middle());
    for (const int domain : source_.domains.of_node.of(n))
      release(domain, released, released / bulk * field.mean_stress(offset), field);
  }
}

PALPATE_INLINE void PatchProjection::release(int domain, double bulk, const Vector3& mean_stress,
                                             const HalfSpaceField& field) {
  const VolumeDomains& domains = source_.domains;
  const auto d = static_cast<std::size_t>(domain);
  const auto begin = static_cast<std::size_t>(domains.first[d]), end = static_cast<std::size_t>(domains.first[d + 1]);
  const double volume = domains.volume[d];
  const auto is_free = [&](std::size_t a) { return patch_.index_of(domains.node[a]) >= 0; };
  Vector3 stress = -mean_stress;  // what the stiffness has in place of it, from the nodes that are not free
  for (std::size_t b = begin; b < end; ++b)
    if (!is_free(b)) stress += bulk * (boundary_value(domains.node[b], field).transpose() * domains.gradient[b]);
  for (std::size_t a = begin; a < end; ++a) {
    if (!is_free(a)) continue;
    const Index row = 3 * Index{patch_.index_of(domains.node[a])};
    const Vector3 g = volume * domains.gradient[a];
    right_.block<3, 3>(row, 0) += g * stress.transpose();
    for (std::size_t b = begin; b < end; ++b) {
      const Index column = 3 * Index{patch_.index_of(domains.node[b])};
      if (column >= 0 && column <= row)
        matrix_.block<3, 3>(row, column) -= bulk * (g * domains.gradient[b].transpose());
    }
  }
}

PALPATE_INLINE bool PatchProjection::solve_dense() {
  constexpr double largest_residual = 1e-8;
  const Index size = matrix_.rows();
  solution_.resize(size, 3);
  bool good = right_.allFinite() && matrix_.diagonal().allFinite();
  return good && attempt_unless_refused([&] {
           DenseCholesky factor(matrix_, {});
           VectorX product(size);
           for (Index c = 0; c < 3; ++c) {
             b_ = right_.col(c);
             x_.resize(size);
             factor.solve_into(b_, x_);
             symmetric_product(matrix_, x_.data(), product.data());
             good = good && (product - b_).norm() <= largest_residual * b_.norm();
             solution_.col(c) = x_;
           }
         }) &&
         good;
}

/// Depth of a node below the middle of the patch; infinite where it is above, or more than about a length aside: in an
/// unstructured mesh no node may be straight below.
PALPATE_INLINE double PatchProjection::depth_below(NodeId node, NodeId middle, const Vector3& normal) const noexcept {
  constexpr double beside = 1.2, surface = 0.05;  // lengths between nodes
  const double length = source_.boundary.length(middle);
  const Vector3 path = source_.position(node) - source_.position(middle);
  const double depth = -path.dot(normal);
  return depth > surface * length && (path + depth * normal).norm() < beside * length ? depth : infinity;
}

/// Depth of the nearest node below the middle of the patch that is fixed along the normal, in lengths between nodes
/// (half an edge of a quadratic element); infinite where there is none. What such nodes do to a dent changes within a
/// facet if they are near, and then the compliance that remains without the half-space is not smooth: its sum with the
/// half-space may not even be positive definite.
PALPATE_INLINE double PatchProjection::support_below(NodeId middle, const Vector3& normal) const noexcept {
  double nearest = infinity;
  for (const NodeId n : patch_.nodes())
    if (is_fixed_along(normal, source_.constrained[static_cast<std::size_t>(n)]))
      nearest = std::min(nearest, depth_below(n, middle, normal));
  return nearest / source_.boundary.length(middle);
}

/// Whether a node below is on a surface that faces away, and can move along the normal: the body can bend there.
PALPATE_INLINE bool PatchProjection::is_free_side_below(NodeId node, NodeId middle,
                                                        const Vector3& normal) const noexcept {
  constexpr double opposite = -0.5;
  return source_.boundary.is_on_boundary(node) && source_.boundary.normal(node).dot(normal) < opposite &&
         !is_fixed_along(normal, source_.constrained[static_cast<std::size_t>(node)]) &&
         depth_below(node, middle, normal) < infinity;
}

PALPATE_INLINE int PatchProjection::count_layers(NodeId middle, const Vector3& normal) const noexcept {
  for (int layers = 1; layers <= source_.layers; ++layers)
    for (const NodeId n : patch_.nodes(layers).subspan(patch_.nodes(layers - 1).size()))
      if (is_free_side_below(n, middle, normal)) return layers;
  return 0;
}

PALPATE_INLINE void PatchProjection::solve(int vertex, const Vector3& normal, std::vector<PatchEntry>& entries,
                                           HalfSpaceMarks& marks) {
  const NodeId middle = source_.touched[static_cast<std::size_t>(vertex)];
  const VertexMaterial& material = source_.materials[static_cast<std::size_t>(vertex)];
  const UniformStiffness& stiffness = source_.stiffness[static_cast<std::size_t>(material.stiffness)];
  patch_.find(middle, normal);
  if (patch_.is_cut()) marks.set(HalfSpaceMark::near_edge);
  constexpr double near_edge = 1.3, too_near = 0.7;  // edges of elements, lengths between nodes
  const double support = support_below(middle, normal);
  if (support < near_edge * source_.mesh.element.order) marks.set(HalfSpaceMark::near_support);
  layers_across_ = count_layers(middle, normal);
  if (support < too_near) return marks.set(HalfSpaceMark::thin);
  const HalfSpaceField field(stiffness.shear_modulus, stiffness.poisson_ratio, normal);
  load_.compute(patch_, field, normal, right_);
  assemble(stiffness, field);
  release_cut_domains(stiffness, field);
  if (!solve_dense()) return marks.set(HalfSpaceMark::singular);
  for (const NodeId n : patch_.free()) {
    const auto found = std::ranges::lower_bound(source_.touched, n);
    if (found == source_.touched.end() || *found != n) continue;
    entries.push_back({static_cast<int>(found - source_.touched.begin()),
                       stiffness.shear_modulus * solution_.block<3, 3>(3 * Index{patch_.index_of(n)}, 0)});
  }
  std::ranges::sort(entries, {}, &PatchEntry::vertex);
}

}}}  // namespace palpate::detail
