// Definitions of refine_near.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/bisection.hpp>
#include <palpate/mesh/detail/curved_boundary.hpp>
#include <palpate/mesh/detail/fibres.hpp>
#include <palpate/mesh/detail/refined_groups.hpp>
#include <palpate/mesh/detail/target_distance.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

[[noreturn]] PALPATE_COLD inline void refuse_option(const std::string& what, double value, double threshold,
                                                    std::string hint) {
  SetupProblem problem;
  problem.what = what + " is " + number(value);
  problem.hint = std::move(hint);
  problem.value = value;
  problem.threshold = threshold;
  raise(std::move(problem));
}

struct MeshQuality {
  double least = infinity, mean = 0.0;
};

inline void check_mesh(const Mesh<Tet4>& mesh) {
  if (mesh.elements.empty()) raise(SetupErrorKind::empty_mesh, "a mesh without elements cannot be refined");
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.elements.size())
    raise(SetupErrorKind::bad_argument,
          std::to_string(mesh.regions.size()) + " regions for " + std::to_string(mesh.elements.size()) + " elements");
  if (mesh.has_fibres()) require_fibre_count(mesh.fibres.size(), mesh.element_count());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!all_finite(mesh.positions[i]))
      raise_at(SetupIds::nodes, static_cast<std::int64_t>(i), SetupErrorKind::non_finite,
               "the position of a node is not finite");
  for (const Group& group : mesh.groups.all()) {
    const auto n = mesh.node_count();
    if (std::ranges::any_of(group.nodes, [n](NodeId i) { return i < 0 || i >= n; }) ||
        std::ranges::any_of(group.elements, [&](Index e) { return e < 0 || e >= mesh.element_count(); }))
      raise(SetupErrorKind::index_out_of_range,
            "group '" + group.name + "' names a node or an element that does not exist");
  }
}

/// Refuses what check_mesh refuses, and elements without positive volume.
inline MeshQuality checked_quality(const Mesh<Tet4>& mesh) {
  check_mesh(mesh);
  MeshQuality quality;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (const NodeId i : mesh.elements[e])
      if (i < 0 || i >= static_cast<NodeId>(mesh.positions.size()))
        raise_at(SetupIds::elements, static_cast<std::int64_t>(e), SetupErrorKind::index_out_of_range,
                 "an element names a node that does not exist");
    const auto shape = element_shape<Tet4>(element_nodes<Tet4>(mesh, static_cast<Index>(e)));
    if (!(shape.quality > 0.0))
      raise_at(SetupIds::elements, static_cast<std::int64_t>(e),
               shape.volume < 0.0 ? SetupErrorKind::inverted_element : SetupErrorKind::degenerate_element,
               "an element has the volume " + number(shape.volume) + " m^3", "Admit the mesh before refinement");
    quality.least = std::min(quality.least, shape.quality);
    quality.mean += shape.quality / static_cast<double>(mesh.elements.size());
  }
  return quality;
}

inline void check_options(const RefineNearOptions& options) {
  if (!(options.quality_kept > 0.0 && options.quality_kept <= 1.0))
    refuse_option("RefineNearOptions::quality_kept", options.quality_kept, 1.0, "Give a fraction: 0 < fraction <= 1");
  if (options.most_nodes < 1)
    refuse_option("RefineNearOptions::most_nodes", static_cast<double>(options.most_nodes), 1.0,
                  "Give the number of nodes at which refinement ends");
}

inline void check_wanted(const WantedEdge& wanted) {
  if (!(wanted.edge > 0.0 && wanted.edge < infinity))
    refuse_option("WantedEdge::edge", wanted.edge, 0.0, "Give the wanted length of edges in metres");
  if (!(wanted.growth > 0.0 && wanted.growth < infinity))
    refuse_option("WantedEdge::growth", wanted.growth, 0.0,
                  "Give how fast the length increases with distance, such as 0.35");
}

inline Mesh<Tet4> refined_mesh(const Mesh<Tet4>& coarse, Bisection& bisection) {
  const DividedEdges divided(bisection.divided(), bisection.first_new_node());
  Bisection::Elements sorted = bisection.sorted_elements();
  Mesh<Tet4> fine;
  fine.groups = refined_groups(coarse, divided, sorted);
  for (Index e = 0; e < coarse.element_count(); ++e) {
    const auto parts = static_cast<std::size_t>(sorted.first[static_cast<std::size_t>(e) + 1] -
                                                sorted.first[static_cast<std::size_t>(e)]);
    if (!coarse.regions.empty()) fine.regions.insert(fine.regions.end(), parts, coarse.region(e));
    if (coarse.has_fibres()) fine.fibres.insert(fine.fibres.end(), parts, coarse.fibre(e));
  }
  fine.region_names = coarse.region_names;
  fine.notes = coarse.notes;
  fine.elements = std::move(sorted.elements);
  fine.positions = std::move(bisection.positions());
  return fine;
}

/// Without a report nobody would learn that the wanted length is not reached.
[[noreturn]] PALPATE_COLD inline void refuse_too_long_edges(const RefineNearReport& report,
                                                            const RefineNearOptions& options) {
  SetupProblem problem;
  problem.kind = report.most_nodes_reached ? SetupErrorKind::too_large : SetupErrorKind::poor_quality;
  problem.what = (report.most_nodes_reached
                      ? "the refined mesh would have more than " + std::to_string(options.most_nodes) + " nodes"
                      : "elements would get less than " + number(options.quality_kept) +
                            " of the least quality before, which is " + number(report.least_quality_before)) +
                 "; " + std::to_string(report.edges_too_long) + " edges are still too long, the worst " +
                 number(report.worst_excess) + " times";
  problem.hint = report.most_nodes_reached
                     ? "Ask for longer edges or a faster growth, raise RefineNearOptions::most_nodes"
                     : "Lower RefineNearOptions::quality_kept";
  problem.hint += ", or pass a report to take the mesh as far as it is refined";
  problem.count = report.edges_too_long;
  problem.value = report.worst_excess;
  problem.threshold = 1.0;
  raise(std::move(problem));
}

/// Refines a mesh that checked_quality has accepted.
inline Mesh<Tet4> refine_checked(const Mesh<Tet4>& mesh, const MeshQuality& before, const Bisection::Wanted& wanted,
                                 const RefineNearOptions& options, RefineNearReport* report) {
  std::optional<CurvedBoundary> curved;
  if (options.surface != nullptr) curved.emplace(*options.surface, mesh);
  Bisection::Limits limits{options.most_nodes, options.quality_kept * before.least, {}};
  if (curved)
    limits.place_on_boundary = [&](NodeId node, const Vector3& middle, double length, const auto& quality_at) {
      return curved->place(node, middle, length, limits.least_quality, quality_at);
    };
  Bisection bisection(mesh, limits);
  const auto too_long = bisection.refine(wanted);
  if (curved) curved->finish(bisection);
  RefineNearReport result;
  result.nodes_before = mesh.node_count();
  result.elements_before = mesh.element_count();
  result.least_quality_before = before.least;
  result.mean_quality_before = before.mean;
  result.edges_too_long = too_long.count;
  result.worst_excess = too_long.worst;
  result.most_nodes_reached = too_long.count > 0 && bisection.is_full();
  if (!result.reached() && report == nullptr) refuse_too_long_edges(result, options);
  Mesh<Tet4> fine = refined_mesh(mesh, bisection);
  const MeshQuality after = checked_quality(fine);
  result.nodes_after = fine.node_count();
  result.elements_after = fine.element_count();
  result.least_quality_after = after.least;
  result.mean_quality_after = after.mean;
  result.shortest_edge = shortest_edge(fine);
  if (curved) {
    result.curved_nodes = curved->count();
    result.distance_to_surface = curved->distance(fine.positions);
  }
  if (report != nullptr) *report = result;
  return fine;
}

}  // namespace detail

PALPATE_INLINE Mesh<Tet4> refine_near(const Mesh<Tet4>& mesh, const detail::EdgeField& wanted,
                                      const RefineNearOptions& options, RefineNearReport* report) {
  if (!wanted) raise(SetupErrorKind::bad_argument, "an empty function as wanted edge length");
  detail::check_options(options);
  const auto before = detail::checked_quality(mesh);
  const auto checked = [&wanted](const Vector3& p, double) {
    const double length = wanted(p);
    if (!(length > 0.0))
      detail::refuse_option("the wanted edge length at " + detail::point_text(p), length, 0.0,
                            "Return a positive length, infinity where nothing is to be refined");
    return length;
  };
  return detail::refine_checked(mesh, before, checked, options, report);
}

PALPATE_INLINE Mesh<Tet4> refine_near(const Mesh<Tet4>& mesh, const std::vector<RefineTarget>& targets,
                                      const detail::WantedEdge& wanted, const RefineNearOptions& options,
                                      RefineNearReport* report) {
  detail::check_wanted(wanted);
  detail::check_options(options);
  if (targets.empty())
    raise(SetupErrorKind::bad_argument, "no target of refinement", "Name what the mesh is to be refined near");
  const auto before = detail::checked_quality(mesh);
  const detail::TargetDistance distance(mesh, targets);
  const auto wanted_at = [&](const Vector3& p, double length) {
    const double reach = (length - wanted.edge) / wanted.growth;
    return reach > 0.0 ? wanted.edge + wanted.growth * distance(p, reach) : infinity;
  };
  return detail::refine_checked(mesh, before, wanted_at, options, report);
}

PALPATE_INLINE Mesh<Tet4> refine_near(const Mesh<Tet4>& mesh, const RefineTarget& target,
                                      const detail::WantedEdge& wanted, const RefineNearOptions& options,
                                      RefineNearReport* report) {
  return refine_near(mesh, std::vector<RefineTarget>{target}, wanted, options, report);
}

namespace detail {

/// Points of the boundary, at most `spacing` [m] from each other, that are in a set.
inline void add_points_within(const where::PointSet& set, const Mesh<Tet4>& mesh,
                              const std::vector<BoundaryFace>& boundary, double spacing, PointCloud& cloud) {
  for (const BoundaryFace& face : boundary) {
    const Vector3 a = mesh.position(face.nodes[0]), ab = mesh.position(face.nodes[1]) - a,
                  ac = mesh.position(face.nodes[2]) - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int parts = static_cast<int>(std::ceil(longest / spacing));
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const Vector3 p = a + (i * ab + j * ac) / parts;
        if (set.contains(p)) cloud.points.push_back(p);
      }
  }
}

/// The touchable part of a scene, for edges of this length.
inline std::vector<RefineTarget> touched_surface(const Mesh<Tet4>& mesh, const Scene& scene, double edge) {
  constexpr double spacing = 0.7;  // edges
  const std::vector<BoundaryFace> boundary = extract_boundary<Tet4>(mesh);
  std::vector<RefineTarget> targets;
  for (const Selection& part : scene.touched()) {
    const auto* set = std::get_if<where::PointSet>(&part);
    PointCloud cloud;
    if (set != nullptr) add_points_within(*set, mesh, boundary, spacing * edge, cloud);
    if (cloud.points.empty())
      targets.emplace_back(nodes_of(resolve_faces(mesh, boundary, part)));
    else
      targets.emplace_back(std::move(cloud));
  }
  return targets;
}

/// The group of these nodes, and the faces and elements that all of their nodes make.
inline void fill_group(Group& group, const std::vector<NodeId>& nodes, const Mesh<Tet4>& mesh,
                       const std::vector<BoundaryFace>& boundary) {
  std::vector<char> is_in(mesh.positions.size(), 0), is_outside = is_in;
  for (const NodeId node : nodes) is_in[static_cast<std::size_t>(node)] = 1;
  const auto all_in = [&](const auto& corners) {
    return std::ranges::all_of(corners, [&](NodeId i) { return is_in[static_cast<std::size_t>(i)] != 0; });
  };
  group.nodes = nodes;
  for (const BoundaryFace& face : boundary) {
    for (const NodeId i : face.nodes) is_outside[static_cast<std::size_t>(i)] = 1;
    if (all_in(face.nodes)) group.faces.emplace_back(face.nodes.begin(), face.nodes.end());
  }
  if (std::ranges::all_of(nodes, [&](NodeId i) { return is_outside[static_cast<std::size_t>(i)] != 0; })) return;
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (all_in(mesh.elements[static_cast<std::size_t>(e)])) group.elements.push_back(e);
}

PALPATE_INLINE bool lists_nodes(const Scene& scene) {
  bool found = false;
  scene.with_selections([&found](const Selection& selection) {
    found = found || std::holds_alternative<std::vector<NodeId>>(selection);
    return selection;
  });
  return found;
}

}  // namespace detail

PALPATE_INLINE Scene name_listed_nodes(Mesh<Tet4>& mesh, const Scene& scene) {
  if (!detail::lists_nodes(scene)) return scene;
  int lists = 0;
  const std::vector<BoundaryFace> boundary = extract_boundary<Tet4>(mesh);
  Scene named = scene.with_selections([&](const Selection& selection) -> Selection {
    const auto* nodes = std::get_if<std::vector<NodeId>>(&selection);
    if (nodes == nullptr) return selection;
    for (const NodeId node : *nodes)
      if (node < 0 || Index{node} >= mesh.node_count())
        raise(SetupErrorKind::index_out_of_range,
              "the scene names node " + std::to_string(node) + ", the mesh has " + std::to_string(mesh.node_count()));
    std::string name;
    do name = "listed nodes " + std::to_string(++lists);
    while (mesh.groups.find(name) != nullptr);
    detail::fill_group(mesh.groups.get_or_add(name, 2), *nodes, mesh, boundary);
    return name;
  });
  mesh.groups.tidy();
  return named;
}

PALPATE_INLINE Mesh<Tet4> refine_near_touched(const Mesh<Tet4>& mesh, const Scene& scene, double edge,
                                              const RefineNearOptions& options, RefineNearReport* report) {
  constexpr double growth = 0.5;
  if (detail::lists_nodes(scene))
    raise(SetupErrorKind::unsupported, "the scene selects by lists of nodes, which new nodes are not in",
          "Name a group of the mesh, give a set of points such as where::box, or call name_listed_nodes first");
  if (!(edge > 0.0 && edge < infinity))
    raise(SetupErrorKind::bad_argument, "the wanted edge length is " + number(edge) + " m");
  return refine_near(mesh, detail::touched_surface(mesh, scene, edge), {edge, growth}, options, report);
}

}}  // namespace palpate
