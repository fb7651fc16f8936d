// The boundary of a mesh as seen from its nodes.
#pragma once

#include <palpate/assembly/detail/node_lists.hpp>
#include <palpate/mesh/surface.hpp>

#include <array>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Faces, triangles, normal and scale of the boundary at every node. Nodes inside the body have none. O(faces),
/// allocates.
class BoundaryNodes {
 public:
  /// Normals that differ by more than 45 degrees make an edge between facets sharp.
  static constexpr double sharp_cosine = 0.70710678118654752440;

  /// Keeps a reference to the faces.
  BoundaryNodes(const MeshRef& mesh, const std::vector<BoundaryFace>& faces);

  const BoundaryFace& face(int f) const noexcept { return (*faces_)[static_cast<std::size_t>(f)]; }
  const std::array<NodeId, 3>& triangle(int t) const noexcept { return triangles_[static_cast<std::size_t>(t)]; }
  /// Outward unit normal of a triangle.
  const Vector3& triangle_normal(int t) const noexcept { return triangle_normals_[static_cast<std::size_t>(t)]; }
  std::span<const NodeId> faces_at(NodeId node) const noexcept { return faces_at_.of(node); }
  std::span<const NodeId> triangles_at(NodeId node) const noexcept { return triangles_at_.of(node); }
  bool is_on_boundary(NodeId node) const noexcept { return !triangles_at_.of(node).empty(); }
  /// Outward unit normal, the mean of the triangles with their angles at the node as weights; zero where they cancel.
  Vector3 normal(NodeId node) const noexcept;
  /// Mean length of the edges at the node [m].
  double length(NodeId node) const noexcept;
  /// Whether the node is on a sharp edge, or on one with fewer or more than two triangles.
  bool is_sharp(NodeId node) const noexcept { return sharp_[static_cast<std::size_t>(node)]; }
  Vector3 position(NodeId node) const noexcept;

 private:
  void list_triangles(const MeshRef& mesh);
  void find_sharp_edges();

  const double* positions_;
  const std::vector<BoundaryFace>* faces_;
  std::vector<std::array<NodeId, 3>> triangles_;
  std::vector<Vector3> triangle_normals_;
  NodeLists faces_at_, triangles_at_;
  std::vector<bool> sharp_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/boundary_nodes.ipp>
#endif
