// Division of a quadratic tetrahedron into linear ones.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/element/tet10.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

}}}  // namespace palpate::detail
