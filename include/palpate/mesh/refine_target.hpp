// What a mesh is refined near, and the surface that refinement follows.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/where.hpp>

#include <array>
#include <string>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Points in space, such as the places where tools will touch [m].
struct PointCloud {
  std::vector<Vector3> points;
};

/// The segments between consecutive points, such as the path of a tool [m].
struct Polyline {
  std::vector<Vector3> points;
};

/// Near what a mesh is refined. A group, a region, "surface" or a list of nodes means the boundary faces all of whose
/// nodes it contains and its other nodes; a region, a group of elements and nodes some of which are inside the body
/// also mean the elements all of whose nodes they contain. A set of points of mesh/where.hpp need not contain a node:
/// to refine near a sphere or a segment pass `where::sphere` or `where::capsule`. The distance to a predicate or a
/// complement is that to the nodes that it selects.
using RefineTarget = std::variant<std::string, std::vector<NodeId>, where::PointSet, PointCloud, Polyline>;

namespace detail {

/// A triangle surface that is finer than the boundary of the mesh, in the same frame [m].
struct CurvedSurface {
  std::vector<Vector3> positions;
  std::vector<std::array<NodeId, 3>> triangles;
};

}  // namespace detail

}}  // namespace palpate
