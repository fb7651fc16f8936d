// Definitions of generators.hpp.
#pragma once

#include <palpate/mesh/generators.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void add_oriented(Mesh<Tet4>& mesh, NodeId a, NodeId b, NodeId c, NodeId d) {
  const auto edge = [&](NodeId to) -> Vector3 {
    return (mesh.positions[static_cast<std::size_t>(to)] - mesh.positions[static_cast<std::size_t>(a)]).normalized();
  };
  const bool inverted = cross(edge(b), edge(c)).dot(edge(d)) < 0.0;
  mesh.elements.push_back(inverted ? Mesh<Tet4>::Connectivity{a, b, d, c} : Mesh<Tet4>::Connectivity{a, b, c, d});
}

PALPATE_INLINE std::array<NodeId, 3> BoxGrid::indices(NodeId n) const noexcept {
  return {n % (cells[0] + 1), n / (cells[0] + 1) % (cells[1] + 1), n / ((cells[0] + 1) * (cells[1] + 1))};
}

PALPATE_INLINE NodeId BoxGrid::corner(std::array<NodeId, 3> cell, unsigned corner) const noexcept {
  for (unsigned a = 0; a < 3; ++a) cell[a] += static_cast<NodeId>(corner >> a & 1u);
  return node(cell);
}

/// The core connects the four corners whose grid indices have an even sum, so that neighbours use the same diagonal on
/// their common face.
inline void split_in_five(Mesh<Tet4>& mesh, const BoxGrid& grid, std::array<NodeId, 3> cell) {
  const unsigned odd = static_cast<unsigned>(cell[0] + cell[1] + cell[2]) & 1u;
  const auto at = [&](unsigned corner) { return grid.corner(cell, corner); };
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned bits = (corner & 1u) + (corner >> 1 & 1u) + (corner >> 2);
    if (((bits + odd) & 1u) != 0) add_oriented(mesh, at(corner), at(corner ^ 1u), at(corner ^ 2u), at(corner ^ 4u));
  }
  const unsigned first = odd;  // one of the core's corners; the others differ from it in two axes
  add_oriented(mesh, at(first), at(first ^ 3u), at(first ^ 5u), at(first ^ 6u));
}

/// One tetrahedron per order of the axes on a path along edges from the first corner to the last.
inline void split_in_six(Mesh<Tet4>& mesh, const BoxGrid& grid, std::array<NodeId, 3> cell) {
  for (unsigned a : {1u, 2u, 4u})
    for (unsigned b : {1u, 2u, 4u})
      if (a != b)
        add_oriented(mesh, grid.corner(cell, 0), grid.corner(cell, a), grid.corner(cell, a | b), grid.corner(cell, 7));
}

PALPATE_INLINE NodeId count_cells(const std::vector<double>& x) {
  bool fine = x.size() >= 2;
  for (std::size_t i = 0; i < x.size(); ++i) fine = fine && std::isfinite(x[i]) && (i == 0 || x[i] > x[i - 1]);
  if (!fine)
    raise(SetupErrorKind::bad_argument, "the coordinates of a box must be finite and rise",
          "Give two or more per axis");
  if (x.size() > 1'000'000)
    raise(SetupErrorKind::count_too_large, std::to_string(x.size()) + " coordinates along one axis");
  return static_cast<NodeId>(x.size() - 1);
}

PALPATE_INLINE std::vector<double> even_coordinates(double origin, double size, int cells) {
  if (!(size > 0.0) || cells < 1 || !std::isfinite(size) || !std::isfinite(origin))
    raise(SetupErrorKind::bad_argument, "a box of size " + number(size) + " in " + std::to_string(cells) + " cells",
          "Sizes and numbers of cells must be positive");
  std::vector<double> x;
  for (int i = 0; i <= cells; ++i) x.push_back(origin + size * i / cells);
  return x;
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Mesh<Tet4> box_tet4(const std::vector<double>& x, const std::vector<double>& y,
                                   const std::vector<double>& z, BoxSplit split) {
  const detail::BoxGrid grid{{detail::count_cells(x), detail::count_cells(y), detail::count_cells(z)}};
  if (6.0 * static_cast<double>(x.size()) * static_cast<double>(y.size()) * static_cast<double>(z.size()) >
      2147483647.0)
    raise(SetupErrorKind::count_too_large, "the box would have more than 2^31 elements");
  Mesh<Tet4> mesh;
  detail::add_grid_nodes(mesh, x, y, z);
  for (NodeId k = 0; k < grid.cells[2]; ++k)
    for (NodeId j = 0; j < grid.cells[1]; ++j)
      for (NodeId i = 0; i < grid.cells[0]; ++i)
        split == BoxSplit::six ? detail::split_in_six(mesh, grid, {i, j, k})
                               : detail::split_in_five(mesh, grid, {i, j, k});
  detail::add_box_groups(mesh, grid);
  return mesh;
}

PALPATE_INLINE Mesh<Tet4> box_tet4(const Vector3& size, std::array<int, 3> cells, BoxSplit split,
                                   const Vector3& origin) {
  return box_tet4(detail::even_coordinates(origin[0], size[0], cells[0]),
                  detail::even_coordinates(origin[1], size[1], cells[1]),
                  detail::even_coordinates(origin[2], size[2], cells[2]), split);
}

}}  // namespace palpate
