// Definitions of refine.hpp.
#pragma once

#include <palpate/mesh/refine.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tri6.hpp>
#include <palpate/mesh/detail/eight_tetrahedra.hpp>
#include <palpate/mesh/promote.hpp>

#include <array>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Replaces every quadratic face by its triangles, and every element by the eight elements that replace it.
inline void refine_group(Group& group) {
  std::vector<std::vector<NodeId>> faces;
  for (const auto& face : group.faces)
    for (const auto& [a, b, c] : Tri6::triangles)
      faces.push_back(
          {face[static_cast<std::size_t>(a)], face[static_cast<std::size_t>(b)], face[static_cast<std::size_t>(c)]});
  group.faces = std::move(faces);
  std::vector<Index> elements;
  for (const Index e : group.elements)
    for (Index i = 0; i < 8; ++i) elements.push_back(8 * e + i);
  group.elements = std::move(elements);
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Mesh<Tet4> refine(const Mesh<Tet4>& coarse) {
  if (coarse.element_count() > std::numeric_limits<NodeId>::max() / 8)
    raise(SetupErrorKind::count_too_large, "the mesh would have more than 2^31 elements");
  Mesh<Tet10> quadratic = promote<Tet10>(coarse);
  Mesh<Tet4> fine;
  fine.elements.reserve(8 * coarse.elements.size());
  for (Index e = 0; e < quadratic.element_count(); ++e) {
    const auto& nodes = quadratic.elements[static_cast<std::size_t>(e)];
    for (const auto& part : detail::eight_tetrahedra(element_nodes<Tet10>(quadratic, e))) {
      Mesh<Tet4>::Connectivity corners;
      for (std::size_t a = 0; a < 4; ++a) corners[a] = nodes[static_cast<std::size_t>(part[a])];
      fine.elements.push_back(corners);
    }
    if (!coarse.regions.empty()) fine.regions.insert(fine.regions.end(), 8, coarse.region(e));
    if (coarse.has_fibres()) fine.fibres.insert(fine.fibres.end(), 8, coarse.fibre(e));
  }
  fine.positions = std::move(quadratic.positions);
  fine.region_names = coarse.region_names;
  fine.notes = coarse.notes;
  fine.groups = std::move(quadratic.groups);
  for (Group& group : fine.groups.all()) detail::refine_group(group);
  return fine;
}

}}  // namespace palpate
