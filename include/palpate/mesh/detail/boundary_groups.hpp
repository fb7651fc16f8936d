// Groups made of boundary faces.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Adds the group of all boundary faces that `choose` accepts, with their nodes. `choose` takes a face or a node; if it
/// takes a node, a face is added if all its nodes are accepted.
template <Element E, class Choose>
void add_boundary_group(Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary, std::string_view name,
                        Choose choose) {
  const auto chosen = [&](const BoundaryFace& face) {
    if constexpr (std::predicate<Choose&, NodeId>)
      return std::ranges::all_of(face.nodes, choose);
    else
      return choose(face);
  };
  Group& group = mesh.groups.get_or_add(name, 2);
  for (const BoundaryFace& face : boundary) {
    if (!chosen(face)) continue;
    group.faces.emplace_back(face.nodes.begin(), face.nodes.end());
    group.nodes.insert(group.nodes.end(), face.nodes.begin(), face.nodes.end());
  }
  mesh.groups.tidy();
}

}  // namespace detail

}}  // namespace palpate
