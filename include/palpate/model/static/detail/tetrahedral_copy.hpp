// A body of any shipped element as linear tetrahedra.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/refine.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The same body in linear tetrahedra, with the same corner nodes on its surface.
struct TetrahedralCopy {
  Mesh<Tet4> mesh;            ///< regions: material of every element; no groups
  std::vector<NodeId> nodes;  ///< node of `mesh` for every node of the body, -1 if it has none
};

/// Collects the tetrahedra of a copy and the nodes that they use.
class TetrahedralCopyMaker {
 public:
  explicit TetrahedralCopyMaker(const MeshRef& mesh) : mesh_(mesh) {
    copy_.nodes.assign(static_cast<std::size_t>(mesh.node_count), -1);
  }

  NodeId node(NodeId of_body) {
    NodeId& id = copy_.nodes[static_cast<std::size_t>(of_body)];
    if (id < 0) id = add(position(of_body));
    return id;
  }
  NodeId add(const Vector3& position) {
    copy_.mesh.positions.push_back(position);
    return static_cast<NodeId>(copy_.mesh.positions.size()) - 1;
  }
  void add_element(const std::array<NodeId, 4>& nodes, int material) {
    copy_.mesh.elements.push_back(nodes);
    copy_.mesh.regions.push_back(material);
    materials_ = std::max(materials_, material + 1);
  }
  Vector3 position(NodeId of_body) const { return Vector3(mesh_.position(of_body)); }

  /// The element as a tetrahedron.
  void whole(const NodeId* nodes, int material) {
    add_element({node(nodes[0]), node(nodes[1]), node(nodes[2]), node(nodes[3])}, material);
  }
  void eight(const NodeId* nodes, int material) {
    ElementNodes<Tet10> x;
    for (int a = 0; a < Tet10::nodes; ++a) x.row(a) = position(nodes[a]).transpose();
    for (const auto& [a, b, c, d] : eight_tetrahedra(x))
      add_element({node(nodes[a]), node(nodes[b]), node(nodes[c]), node(nodes[d])}, material);
  }
  /// Whether the middle nodes of a quadratic tetrahedron are in the middle of its edges.
  bool is_straight(const NodeId* nodes) const {
    constexpr double allowed = 1e-3;  // of the length of the edge
    for (std::size_t i = 0; i < Tet10::edges.size(); ++i) {
      const Vector3 a = position(nodes[Tet10::edges[i][0]]), b = position(nodes[Tet10::edges[i][1]]);
      if ((position(nodes[4 + i]) - 0.5 * (a + b)).norm() > allowed * (b - a).norm()) return false;
    }
    return true;
  }
  /// Two triangles of every face, and a node in the middle.
  void twelve(const NodeId* nodes, int material) {
    Vector3 middle = Vector3::Zero();
    for (int a = 0; a < 8; ++a) middle += position(nodes[a]) / 8.0;
    const NodeId centre = add(middle);
    for (int f = 0; f < mesh_.element.face_count; ++f) {
      const std::span<const int> face = mesh_.element.local_face(f);
      std::array<NodeId, 4> corner{};
      for (std::size_t i = 0; i < 4; ++i) corner[i] = nodes[face[i]];
      std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
      for (std::size_t i = 1; i < 3; ++i)
        add_element({node(corner[0]), node(corner[i + 1]), node(corner[i]), centre}, material);
    }
  }

  TetrahedralCopy take() {
    copy_.mesh.region_names.clear();
    for (int m = 0; m < materials_; ++m) copy_.mesh.region_names.push_back(std::to_string(m));
    return std::move(copy_);
  }

 private:
  const MeshRef& mesh_;
  TetrahedralCopy copy_;
  int materials_ = 0;
};

/// The material of every region, -1 for none; empty when a region has several.
inline std::vector<int> materials_of_regions(const MeshRef& body, const std::function<int(Index)>& material) {
  std::vector<int> materials(body.region_names.size(), -1);
  for (Index e = 0; e < body.element_count; ++e) {
    int& own = materials[static_cast<std::size_t>(body.region(e))];
    if (own >= 0 && own != material(e)) return {};
    own = material(e);
  }
  return materials;
}

/// Whether the nodes of `coarse` are nodes of the body, apart from a translation.
inline bool has_nodes_of(const MeshRef& body, const MeshRef& coarse, const std::vector<NodeId>& node_map) {
  constexpr double rounding = 1e-9;
  const auto point = [](const MeshRef& mesh, Index i) -> Vector3 { return Vector3::Map(mesh.position(i)); };
  if (static_cast<Index>(node_map.size()) < coarse.node_count || coarse.node_count == 0 || node_map[0] < 0)
    return false;
  const Vector3 shift = point(body, node_map[0]) - point(coarse, 0);
  for (Index i = 0; i < coarse.node_count; ++i) {
    const NodeId node = node_map[static_cast<std::size_t>(i)];
    if (node < 0 || (point(body, node) - point(coarse, i) - shift).norm() > rounding * (1.0 + shift.norm()))
      return false;
  }
  return true;
}

/// Tet4 stays as it is, Tet10 becomes one or, where an edge of the body is curved, eight tetrahedra; Hex8 and Hex20
/// become twelve around a node in their middle, with edges through the least node of every face so that neighbours
/// conform. Empty for other elements. `material` gives the material of an element. O(elements), allocates.
inline std::optional<TetrahedralCopy> tetrahedral_copy(const MeshRef& mesh, const std::function<int(Index)>& material) {
  const ElementLayout& element = mesh.element;
  const bool one_kind = element.small_face.nodes == 0;
  const bool tet4 = element.nodes == 4 && element.face_count == 4,
             tet10 = element.nodes == 10 && element.face_count == 4;
  const bool hexahedron =
      one_kind && element.face_count == 6 &&
      ((element.nodes == 8 && element.face.nodes == 4) || (element.nodes == 20 && element.face.nodes == 8));
  if (!tet4 && !tet10 && !hexahedron) return std::nullopt;
  TetrahedralCopyMaker maker(mesh);
  bool straight = true;
  for (Index e = 0; e < mesh.element_count && tet10 && straight; ++e) straight = maker.is_straight(mesh.nodes_of(e));
  for (Index e = 0; e < mesh.element_count; ++e) {
    const NodeId* nodes = mesh.nodes_of(e);
    if (tet4 || (tet10 && straight)) maker.whole(nodes, material(e));
    if (tet10 && !straight) maker.eight(nodes, material(e));
    if (hexahedron) maker.twelve(nodes, material(e));
  }
  return maker.take();
}

/// The same of the tetrahedra that refine_near refined to the mesh of the body. `node_map` gives the body's node for
/// every node of the refined mesh, -1 for none; the first nodes of that are the nodes of `coarse`. Empty if that is not
/// so, or if a region of the body has several materials.
inline std::optional<TetrahedralCopy> coarse_copy(const MeshRef& coarse, const MeshRef& body,
                                                  const std::vector<NodeId>& node_map,
                                                  const std::function<int(Index)>& material) {
  const std::vector<int> materials = materials_of_regions(body, material);
  const auto same_names = [&] { return std::ranges::equal(coarse.region_names, body.region_names); };
  if (materials.empty() || !same_names() || !has_nodes_of(body, coarse, node_map)) return std::nullopt;
  auto copy = tetrahedral_copy(coarse, [&](Index e) { return materials[static_cast<std::size_t>(coarse.region(e))]; });
  if (!copy) return std::nullopt;
  std::vector<NodeId> nodes(static_cast<std::size_t>(body.node_count), -1);
  for (Index i = 0; i < coarse.node_count; ++i) {
    const NodeId own = copy->nodes[static_cast<std::size_t>(i)], node = node_map[static_cast<std::size_t>(i)];
    nodes[static_cast<std::size_t>(node)] = own;
    if (own >= 0) copy->mesh.positions[static_cast<std::size_t>(own)] = Vector3::Map(body.position(node));
  }
  copy->nodes = std::move(nodes);
  return copy;
}

}}}  // namespace palpate::detail
