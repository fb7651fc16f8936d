// Distance of a point to what a mesh is refined near.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/detail/simplex_tree.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/refine_target.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Distance to the nearest of several targets.
class TargetDistance {
 public:
  /// Throws what refine_near throws for targets.
  TargetDistance(const Mesh<Tet4>& mesh, const std::vector<RefineTarget>& targets);

  /// Infinite beyond `reach` [m]; to sets of points accurate to a thousandth of `reach`.
  double operator()(const Vector3& p, double reach) const;

 private:
  SimplexTree tree_;
  std::vector<where::PointSet> sets_;
};

/// Collects the simplices of targets and checks them.
class TargetReader {
 public:
  explicit TargetReader(const Mesh<Tet4>& mesh) : mesh_(&mesh), box_(detail::box_of(mesh.positions)) {}

  void operator()(const std::string& name) { add_part(name); }
  void operator()(const std::vector<NodeId>& nodes) { add_part(nodes); }
  void operator()(const where::PointSet& set) {
    const double diagonal = box_.size().norm();
    const auto is_near = [&](const Vector3& x) { return set.contains(x) || set.contains(x, diagonal); };
    const bool is_empty = std::ranges::none_of(mesh_->positions, is_near);
    if (is_empty) raise(SetupErrorKind::empty_group, set.name() + " contains no point near the mesh", extent());
    for (const NodeId i : nodes_within(*mesh_, set)) add({i});
    sets.push_back(set);
  }
  void operator()(const PointCloud& cloud) {
    require_points(cloud.points, "a point cloud");
    for (const Vector3& p : cloud.points) simplices.push_back({{p, p, p, p}, 1});
  }
  void operator()(const Polyline& line) {
    require_points(line.points, "a polyline");
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const Vector3 &from = line.points[i], &to = line.points[std::min(i + 1, line.points.size() - 1)];
      simplices.push_back({{from, to, to, to}, 2});
    }
  }

  std::vector<SimplexCorners> simplices;
  std::vector<where::PointSet> sets;

 private:
  void add(std::initializer_list<NodeId> corners) {
    SimplexCorners s{{}, static_cast<int>(corners.size())};
    s.corners.fill(mesh_->position(*corners.begin()));  // a simplex has up to four corners, and all are copied
    std::ranges::transform(corners, s.corners.begin(), [&](NodeId i) { return mesh_->position(i); });
    simplices.push_back(s);
  }

  /// The faces of a part of the surface, the elements of a part of the body, and nodes that belong to none of them.
  void add_part(const Selection& selection) {
    if (!boundary_) boundary_ = extract_boundary<Tet4>(*mesh_);
    const auto nodes = resolve_nodes(*mesh_, *boundary_, selection);
    std::vector<char> is_in(mesh_->positions.size(), 0), is_covered = is_in;
    for (const NodeId i : nodes) is_in[static_cast<std::size_t>(i)] = 1;
    const auto is_part = [&](const auto& corners) {
      if (!std::ranges::all_of(corners, [&](NodeId i) { return is_in[static_cast<std::size_t>(i)] != 0; }))
        return false;
      for (const NodeId i : corners) is_covered[static_cast<std::size_t>(i)] = 1;
      return true;
    };
    if (is_solid(selection, nodes))
      for (const auto& e : mesh_->elements)
        if (is_part(e)) add({e[0], e[1], e[2], e[3]});
    for (const BoundaryFace& f : *boundary_)
      if (is_part(f.nodes)) add({f.nodes[0], f.nodes[1], f.nodes[2]});
    for (const NodeId i : nodes)
      if (is_covered[static_cast<std::size_t>(i)] == 0) add({i});
  }

  /// Whether a selection means elements: a group of elements, a region, or nodes some of which are inside the body. The
  /// nodes alone do not decide: in a thin part all of them are on the surface.
  bool is_solid(const Selection& selection, const std::vector<NodeId>& nodes) const {
    if (const auto* name = std::get_if<std::string>(&selection)) {
      const Group* group = mesh_->find_group(*name);
      if (group != nullptr && !group->elements.empty()) return true;
      if (group == nullptr && *name != surface_group) return true;
    }
    return !std::ranges::includes(nodes_of(*boundary_), nodes);
  }

  void require_points(const std::vector<Vector3>& points, const std::string& what) const {
    if (points.empty())
      raise(SetupErrorKind::bad_argument, what + " without points as target of refinement",
            "Give the places where the mesh is to be fine");
    double nearest = infinity;
    for (const Vector3& p : points) {
      if (!all_finite(p)) raise(SetupErrorKind::non_finite, what + " has a point " + point_text(p));
      nearest = std::min(nearest, box_.squared_distance(p));
    }
    if (SetupProblem problem; std::sqrt(nearest) > box_.size().norm()) {
      problem.what = what + " is " + number(std::sqrt(nearest)) + " m away from the mesh, whose diagonal is " +
                     number(box_.size().norm()) + " m";
      problem.hint = "Use the frame and the unit of the mesh. " + extent();
      problem.value = std::sqrt(nearest);
      problem.threshold = box_.size().norm();
      raise(problem);
    }
  }
  std::string extent() const {
    return "The mesh extends from " + point_text(box_.low) + " to " + point_text(box_.high) + " [m]";
  }

  const Mesh<Tet4>* mesh_;
  Box box_;
  std::optional<std::vector<BoundaryFace>> boundary_;
};

inline TargetDistance::TargetDistance(const Mesh<Tet4>& mesh, const std::vector<RefineTarget>& targets) {
  TargetReader reader(mesh);
  for (const RefineTarget& target : targets) std::visit(reader, target);
  tree_ = SimplexTree(std::move(reader.simplices));
  sets_ = std::move(reader.sets);
}

/// Least margin up to `reach` with which a set contains p. A set that does not grow with its margin (a predicate, a
/// complement) contains p at once or not at all.
inline double margin_distance(const where::PointSet& set, const Vector3& p, double reach) {
  if (set.contains(p)) return 0.0;
  if (!set.contains(p, reach)) return infinity;
  double low = 0.0, high = reach;
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (low + high);
    (set.contains(p, middle) ? high : low) = middle;
  }
  return high;
}

inline double TargetDistance::operator()(const Vector3& p, double reach) const {
  double distance = tree_.nearest(p, reach).distance;
  for (const where::PointSet& set : sets_)
    if (distance > 0.0) distance = std::min(distance, margin_distance(set, p, std::min(reach, distance)));
  return distance;
}

}}}  // namespace palpate::detail
