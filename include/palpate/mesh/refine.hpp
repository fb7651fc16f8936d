// Uniform refinement of tetrahedra.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/promote.hpp>

#include <array>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// The eight tetrahedra of a straight Tet10: one per corner, and the octahedron between the middles cut along its
/// shortest diagonal, which keeps the elements from getting worse with every refinement (Bey 1995 cuts a fixed one).
inline std::array<std::array<int, 4>, 8> eight_tetrahedra(const ElementNodes<Tet10>& x) {
  constexpr std::array<std::array<int, 2>, 3> diagonals{{{4, 9}, {5, 7}, {6, 8}}};
  // For every diagonal, the octahedron's other four corners around it, right-handed about its direction.
  constexpr std::array<std::array<int, 4>, 3> around{{{6, 7, 8, 5}, {8, 9, 6, 4}, {5, 9, 7, 4}}};
  std::size_t shortest = 0;
  const auto square = [&](std::size_t i) {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double d = x(diagonals[i][0], c) - x(diagonals[i][1], c);
      sum += d * d;
    }
    return sum;
  };
  for (std::size_t i : {1u, 2u})
    if (square(i) < square(shortest)) shortest = i;
  std::array<std::array<int, 4>, 8> parts{{{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};
  const auto [from, to] = diagonals[shortest];
  for (std::size_t i = 0; i < 4; ++i) parts[4 + i] = {from, around[shortest][i], around[shortest][(i + 1) % 4], to};
  return parts;
}

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

}  // namespace detail

/// Cuts every tetrahedron into eight, each with an eighth of its volume. Nodes keep their ids, element e becomes 8 e
/// ... 8 e + 7; regions, fibres and groups are transferred as in `promote`. Neighbours conform: the choice of the
/// diagonal affects only the interior of an element. Throws as promote does, and count_too_large beyond 2^31 elements.
inline Mesh<Tet4> refine(const Mesh<Tet4>& coarse) {
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
