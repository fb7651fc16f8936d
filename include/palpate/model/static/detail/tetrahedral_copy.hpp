// A body of any shipped element as linear tetrahedra.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The same body in linear tetrahedra, with the same corner nodes on its surface.
struct TetrahedralCopy {
  Mesh<Tet4> mesh;            ///< regions: material of every element; no groups
  std::vector<NodeId> nodes;  ///< node of `mesh` for every node of the body, -1 if it has none
};

/// Tet4 stays as it is, Tet10 becomes one or, where an edge of the body is curved, eight tetrahedra; Hex8 and Hex20
/// become twelve around a node in their middle, with edges through the least node of every face so that neighbours
/// conform. Empty for other elements. `material` gives the material of an element. O(elements), allocates.
std::optional<TetrahedralCopy> tetrahedral_copy(const MeshRef& mesh, const std::function<int(Index)>& material);

/// The same of the tetrahedra that refine_near refined to the mesh of the body. `node_map` gives the body's node for
/// every node of the refined mesh, -1 for none; the first nodes of that are the nodes of `coarse`. Empty if that is not
/// so, or if a region of the body has several materials.
std::optional<TetrahedralCopy> coarse_copy(const MeshRef& coarse, const MeshRef& body,
                                           const std::vector<NodeId>& node_map,
                                           const std::function<int(Index)>& material);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/tetrahedral_copy.ipp>
#endif
