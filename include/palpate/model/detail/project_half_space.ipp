// Definitions of project_half_space.hpp.
#pragma once

#include <palpate/core/executor.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/model/detail/patch_projection.hpp>
#include <palpate/model/detail/project_half_space.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Largest difference of a material from the isotropic one with the same moduli, relative to its largest entry.
inline double anisotropy(const Matrix6& d) noexcept {
  const double mu = equivalent_shear_modulus(d), lambda = bulk_modulus(d) - 2.0 / 3.0 * mu;
  double difference = 0.0;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      const double same = (i < 3 && j < 3 ? lambda : 0.0) + (i != j ? 0.0 : i < 3 ? 2.0 * mu : mu);
      difference = std::max(difference, std::abs(d(i, j) - same));
    }
  return difference / d.cwiseAbs().maxCoeff();
}

/// The isotropic material that stands for an elasticity matrix.
struct EquivalentMaterial {
  double shear_modulus = 0.0, poisson_ratio = 0.0;
  int ratio = 0;  // number of the Poisson ratio, of matrices that are used
  bool anisotropic = false;

  bool is_like(const EquivalentMaterial& other) const noexcept {
    return std::abs(shear_modulus - other.shear_modulus) <= same * shear_modulus &&
           std::abs(poisson_ratio - other.poisson_ratio) <= same;
  }
  static constexpr double same = 1e-6;
};

/// The equivalent material of every elasticity matrix. Adds each Poisson ratio of the matrices in use to `ratios` once.
inline std::vector<EquivalentMaterial> equivalent_materials(std::span<const Matrix6> elasticities,
                                                            const std::vector<bool>& used,
                                                            std::vector<double>& ratios) {
  constexpr double largest_ratio = 0.49999, anisotropic = 0.05;
  std::vector<EquivalentMaterial> materials;
  for (std::size_t m = 0; m < elasticities.size(); ++m) {
    const Matrix6& d = elasticities[m];
    const double nu = std::min(equivalent_poisson_ratio(d), largest_ratio);
    materials.push_back({equivalent_shear_modulus(d), nu, 0, anisotropy(d) > anisotropic});
    if (!used[m]) continue;
    auto known = std::ranges::find_if(ratios, [&](double r) { return std::abs(r - nu) <= EquivalentMaterial::same; });
    if (known == ratios.end()) known = ratios.insert(known, nu);
    materials.back().ratio = static_cast<int>(known - ratios.begin());
  }
  return materials;
}

/// The mean of the materials of elements.
inline VertexMaterial mean_material(std::span<const NodeId> elements, std::span<const int> material_of,
                                    std::span<const EquivalentMaterial> materials, std::vector<int>& votes) {
  VertexMaterial mean;
  std::ranges::fill(votes, 0);
  for (const NodeId e : elements) {
    const EquivalentMaterial& material = materials[static_cast<std::size_t>(material_of[static_cast<std::size_t>(e)])];
    mean.shear_modulus += material.shear_modulus;
    ++votes[static_cast<std::size_t>(material.ratio)];
    if (material.anisotropic) mean.marks.set(HalfSpaceMark::anisotropic);
  }
  mean.shear_modulus /= static_cast<double>(elements.size());
  mean.stiffness = static_cast<int>(std::ranges::max_element(votes) - votes.begin());
  return mean;
}

/// Whether all elements within two of a node, and those nearer than its longest edge, are of one material. A layer of
/// flat elements may be thinner than its facets are long.
inline bool is_uniform_near(NodeId node, const MeshRef& mesh, const NodeElements& around,
                            std::span<const int> material_of, std::span<const EquivalentMaterial> materials) {
  const auto material = [&](NodeId e) -> const EquivalentMaterial& {
    return materials[static_cast<std::size_t>(material_of[static_cast<std::size_t>(e)])];
  };
  const EquivalentMaterial& first = material(around.of(node)[0]);
  const auto distance = [&](NodeId other) {
    const double *const x = mesh.position(node), *const y = mesh.position(other);
    return std::hypot(y[0] - x[0], y[1] - x[1], y[2] - x[2]);
  };
  double longest = 0.0;
  std::vector<NodeId> near_nodes{node};
  for (std::size_t k = 0; k < near_nodes.size(); ++k)
    for (const NodeId e : around.of(near_nodes[k])) {
      if (!first.is_like(material(e))) return false;
      for (int a = 0; a < mesh.element.nodes; ++a) {
        const NodeId other = mesh.nodes_of(e)[a];
        if (k == 0) longest = std::max(longest, distance(other));
        if ((k == 0 || distance(other) <= longest) && std::ranges::find(near_nodes, other) == near_nodes.end())
          near_nodes.push_back(other);
      }
    }
  return true;
}

PALPATE_INLINE std::vector<VertexMaterial> vertex_materials(const MeshRef& mesh, std::span<const NodeId> touched,
                                                            const NodeElements& around,
                                                            std::span<const Matrix6> elasticities,
                                                            std::span<const int> material_of,
                                                            std::vector<double>& ratios) {
  std::vector<bool> used(elasticities.size(), false);
  for (const NodeId node : touched)
    for (const NodeId e : around.of(node))
      used[static_cast<std::size_t>(material_of[static_cast<std::size_t>(e)])] = true;
  const auto materials = equivalent_materials(elasticities, used, ratios);
  std::vector<int> votes(ratios.size());
  std::vector<VertexMaterial> result;
  for (const NodeId node : touched) {
    VertexMaterial& mean = result.emplace_back(mean_material(around.of(node), material_of, materials, votes));
    mean.poisson_ratio = ratios[static_cast<std::size_t>(mean.stiffness)];
    if (elasticities.size() > 1 && !is_uniform_near(node, mesh, around, material_of, materials))
      mean.marks.set(HalfSpaceMark::several_materials);
  }
  return result;
}

/// Projects all vertices of a source and collects the results.
class HalfSpaceTable {
 public:
  HalfSpaceTable(const HalfSpaceSource& source, const SetupLimits& limits)
      : source_(source), limits_(limits), entries_(source.touched.size()) {
    place_vertices();
  }

  ProjectedHalfSpace make() {
    project();
    ProjectedHalfSpace::Blocks blocks = collect();
    return {std::move(points_), std::move(marks_), std::move(blocks)};
  }

 private:
  void place_vertices();
  void project();
  void project_vertex(PatchProjection& worker, int v);
  bool is_linear_tetrahedron() const noexcept { return source_.mesh.element.nodes == 4; }
  double bending_error(int layers_across) const noexcept;
  double reach_of_edge(double poisson_ratio) const noexcept;
  bool is_disturbed(int v) const noexcept;
  Index longest_axis() const;
  std::vector<std::vector<int>> neighbours() const;
  Matrix3 value(int i, int j) const;
  Matrix3 one_way(int i, int j) const;
  ProjectedHalfSpace::Blocks collect() const;

  const HalfSpaceSource& source_;
  const SetupLimits& limits_;
  std::vector<HalfSpacePoint> points_;
  std::vector<HalfSpaceMarks> marks_;
  std::vector<std::vector<PatchEntry>> entries_;  // per middle of a patch
};

PALPATE_INLINE void HalfSpaceTable::place_vertices() {
  const MeshComponents components = connected_components(source_.mesh);
  for (std::size_t v = 0; v < source_.touched.size(); ++v) {
    const NodeId node = source_.touched[v];
    const VertexMaterial& material = source_.materials[v];
    HalfSpacePoint& point = points_.emplace_back();
    point.body = static_cast<int>(components.of_node[static_cast<std::size_t>(node)]);
    point.position = source_.position(node);
    point.normal = source_.boundary.normal(node);
    point.length = source_.boundary.length(node);
    point.poisson_ratio = material.poisson_ratio;
    HalfSpaceMarks& marks = marks_.emplace_back(material.marks);
    if (point.normal.isZero()) {
      marks.set(HalfSpaceMark::no_surface);
      continue;
    }
    point.is_fixed = is_fixed_along(point.normal, source_.constrained[static_cast<std::size_t>(node)]);
    if (point.is_fixed) continue;
    point.root = HalfSpacePoint::root_of(material.shear_modulus);
    if (source_.boundary.is_sharp(node)) marks.set(HalfSpaceMark::sharp_edge);
    if (source_.constrained[static_cast<std::size_t>(node)] != 0) marks.set(HalfSpaceMark::near_support);
  }
}

/// Estimated relative error of the stiffness in bending of a part with that many elements across it. Fitted to presses
/// on lobes, plates and cantilevers of one to three elements, Poisson ratios to 0.49, so that it falls below a tenth
/// where the error does. With one Tet4 across the error is 1.6 to 6, by the pattern of the mesh.
PALPATE_INLINE double HalfSpaceTable::bending_error(int layers_across) const noexcept {
  if (layers_across == 0) return 0.0;
  const ElementLayout& element = source_.mesh.element;
  constexpr double tet4 = 2.0, smoothed = 0.3, hexahedron = 1.6, tet10 = 0.09, quadratic = 0.2;
  const double of_one = element.nodes == 10        ? tet10
                        : element.order > 1        ? quadratic
                        : !source_.domains.empty() ? smoothed
                        : is_linear_tetrahedron()  ? tet4
                                                   : hexahedron;
  return of_one / (layers_across * layers_across);
}

/// Up to which part of a long facet beside a sharp edge presses are more than a tenth too stiff: spheres of 0.3 to 1.25
/// facets, depths of 0.05 to 0.8 radii, against meshes four times as fine. Tet4 locks at the edge.
PALPATE_INLINE double HalfSpaceTable::reach_of_edge(double poisson_ratio) const noexcept {
  return !source_.domains.empty() ? 0.25 : std::clamp(0.3 + 2.0 * (poisson_ratio - 0.3), 0.3, 0.7);
}

/// Above a support that is not thin, and on facets at an edge, linear tetrahedra have forces within a tenth all the
/// same, unless the edge is too near (HalfSpacePoint::edge_nearness): measured with presses against quadratic elements
/// on fine meshes. Others are up to 19 % too soft.
PALPATE_INLINE bool HalfSpaceTable::is_disturbed(int v) const noexcept {
  const auto i = static_cast<std::size_t>(v);
  const HalfSpaceMarks marks = marks_[i];
  if (source_.constrained[static_cast<std::size_t>(source_.touched[i])] != 0) return true;
  if (marks.has(HalfSpaceMark::several_materials) || marks.has(HalfSpaceMark::anisotropic)) return true;
  if (marks.has(HalfSpaceMark::thin)) return true;
  return !is_linear_tetrahedron() && (marks.has(HalfSpaceMark::sharp_edge) || marks.has(HalfSpaceMark::near_support));
}

PALPATE_INLINE void HalfSpaceTable::project_vertex(PatchProjection& worker, int v) {
  const auto i = static_cast<std::size_t>(v);
  if (points_[i].root == 0.0) return;
  worker.solve(v, points_[i].normal, entries_[i], marks_[i]);
  const HalfSpaceMarks marks = marks_[i];
  if (marks.has(HalfSpaceMark::singular) || marks.has(HalfSpaceMark::thin)) points_[i].root = 0.0;
  points_[i].is_disturbed = is_disturbed(v);
  if (marks.has(HalfSpaceMark::sharp_edge))
    points_[i].edge_nearness = 1.0 / (1.0 - reach_of_edge(points_[i].poisson_ratio));
  points_[i].bending_error = bending_error(worker.layers_across());
}

PALPATE_INLINE void HalfSpaceTable::project() {
  const auto count = static_cast<Index>(points_.size());
  const int threads = limits_.threads.threads();
  const ColumnBlocks columns(source_.stiffness[0].matrix->pattern());
  std::vector<std::unique_ptr<PatchProjection>> workers(static_cast<std::size_t>(threads));
  constexpr Index least = 16;  // vertices for a thread: they take milliseconds
  const Index turn = Index{256} * threads;
  for (Index first = 0; first < count; first += turn) {
    limits_.advance("compliance", static_cast<double>(first) / static_cast<double>(count));
    thread_ranges(std::min(turn, count - first), least, limits_.threads, [&](int thread, Index begin, Index end) {
      auto& worker = workers[static_cast<std::size_t>(thread)];
      if (!worker) worker = std::make_unique<PatchProjection>(source_, columns);
      for (Index v = first + begin; v < first + end; ++v) project_vertex(*worker, static_cast<int>(v));
    });
  }
}

PALPATE_INLINE Index HalfSpaceTable::longest_axis() const {
  Vector3 low = Vector3::Constant(infinity), high = -low;
  for (const HalfSpacePoint& p : points_) {
    low = low.cwiseMin(p.position);
    high = high.cwiseMax(p.position);
  }
  Index axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

/// For every vertex, itself and the vertices of lower number within its support, in ascending order.
PALPATE_INLINE std::vector<std::vector<int>> HalfSpaceTable::neighbours() const {
  std::vector<std::vector<int>> near_vertices(points_.size());
  const Index axis = longest_axis();
  std::vector<int> order;  // along that axis, without vertices that are left as they are
  double longest = 0.0;
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (points_[v].root > 0.0) {
      order.push_back(static_cast<int>(v));
      longest = std::max(longest, points_[v].length);
    }
  const auto point = [&](int v) -> const HalfSpacePoint& { return points_[static_cast<std::size_t>(v)]; };
  std::ranges::sort(order, {}, [&](int v) { return std::pair(point(v).position[axis], v); });
  for (auto first = order.begin(); first != order.end(); ++first) {
    near_vertices[static_cast<std::size_t>(*first)].push_back(*first);
    const double end = point(*first).position[axis] + 2.0 * (point(*first).length + longest);
    for (auto other = first + 1; other != order.end() && point(*other).position[axis] < end; ++other)
      if (half_space_support(point(*first), point(*other)) > 0.0)
        near_vertices[static_cast<std::size_t>(std::max(*first, *other))].push_back(std::min(*first, *other));
  }
  for (auto& list : near_vertices) std::ranges::sort(list);
  return near_vertices;
}

/// Displacement of vertex i per force on vertex j: that of the patch around j, or of the half-space beyond the patch.
PALPATE_INLINE Matrix3 HalfSpaceTable::one_way(int i, int j) const {
  const HalfSpacePoint &to = points_[static_cast<std::size_t>(i)], &from = points_[static_cast<std::size_t>(j)];
  const auto& entries = entries_[static_cast<std::size_t>(j)];
  const auto found = std::ranges::lower_bound(entries, i, {}, &PatchEntry::vertex);
  if (found == entries.end() || found->vertex != i) return half_space_compliance(to, from);
  return 4.0 * std::numbers::pi * to.root * from.root * found->compliance;
}

PALPATE_INLINE Matrix3 HalfSpaceTable::value(int i, int j) const {
  const Matrix3 mean = 0.5 * (one_way(i, j) + Matrix3(one_way(j, i).transpose()));
  return half_space_support(points_[static_cast<std::size_t>(i)], points_[static_cast<std::size_t>(j)]) * mean;
}

PALPATE_INLINE ProjectedHalfSpace::Blocks HalfSpaceTable::collect() const {
  const auto near_vertices = neighbours();
  ProjectedHalfSpace::Blocks blocks;
  blocks.row_start.push_back(0);
  for (const auto& row : near_vertices) {
    blocks.column.insert(blocks.column.end(), row.begin(), row.end());
    blocks.row_start.push_back(static_cast<Index>(blocks.column.size()));
  }
  limits_.require_memory(static_cast<double>(blocks.column.size()) * sizeof(Matrix3), "the projected half-space");
  blocks.value.reserve(blocks.column.size());
  for (std::size_t i = 0; i < near_vertices.size(); ++i)
    for (const int j : near_vertices[i]) blocks.value.push_back(value(static_cast<int>(i), j));
  return blocks;
}

inline void require_sizes(const HalfSpaceSource& source) {
  const auto nodes = static_cast<std::size_t>(source.mesh.node_count);
  const bool fits = source.materials.size() == source.touched.size() && source.constrained.size() == nodes &&
                    !source.stiffness.empty() && source.layers > 0 && std::ranges::is_sorted(source.touched) &&
                    std::ranges::all_of(source.stiffness, [&](const auto& k) {
                      return k.matrix != nullptr && k.matrix->size() == 3 * source.mesh.node_count;
                    });
  if (!fits)
    raise(SetupErrorKind::bad_argument, "the lists for the projection of a half-space do not have the size of the mesh",
          "Give a material per touched vertex, a mark per node, and the stiffness of all nodes");
}

PALPATE_INLINE ProjectedHalfSpace project_half_space(const HalfSpaceSource& source, const SetupLimits& limits) {
  if (source.touched.empty()) return {};
  require_sizes(source);
  return HalfSpaceTable(source, limits).make();
}

}}}  // namespace palpate::detail
