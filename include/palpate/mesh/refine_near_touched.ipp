// Definitions of refine_near_touched.hpp.
#pragma once

#include <palpate/mesh/refine_near_touched.hpp>

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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

}  // namespace detail

PALPATE_INLINE bool lists_nodes(const Scene& scene) {
  bool found = false;
  scene.with_selections([&found](const Selection& selection) {
    found = found || std::holds_alternative<std::vector<NodeId>>(selection);
    return selection;
  });
  return found;
}

PALPATE_INLINE Scene name_listed_nodes(Mesh<Tet4>& mesh, const Scene& scene) {
  if (!lists_nodes(scene)) return scene;
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
  if (lists_nodes(scene))
    raise(SetupErrorKind::unsupported, "the scene selects by lists of nodes, which new nodes are not in",
          "Name a group of the mesh, give a set of points such as where::box, or call name_listed_nodes first");
  if (!(edge > 0.0 && edge < infinity))
    raise(SetupErrorKind::bad_argument, "the wanted edge length is " + number(edge) + " m");
  return refine_near(mesh, detail::touched_surface(mesh, scene, edge), {edge, growth}, options, report);
}

}}  // namespace palpate
