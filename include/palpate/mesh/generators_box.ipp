// Definitions of generators_box.hpp.
#pragma once

#include <palpate/mesh/generators_box.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/promote.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Mesh<Hex8> box_hex8(const std::vector<double>& x, const std::vector<double>& y,
                                   const std::vector<double>& z) {
  const detail::BoxGrid grid{{detail::count_cells(x), detail::count_cells(y), detail::count_cells(z)}};
  if (static_cast<double>(x.size()) * static_cast<double>(y.size()) * static_cast<double>(z.size()) > 2147483647.0)
    raise(SetupErrorKind::count_too_large, "the box would have more than 2^31 nodes");
  Mesh<Hex8> mesh;
  detail::add_grid_nodes(mesh, x, y, z);
  for (NodeId k = 0; k < grid.cells[2]; ++k)
    for (NodeId j = 0; j < grid.cells[1]; ++j)
      for (NodeId i = 0; i < grid.cells[0]; ++i) {
        const auto at = [&](unsigned corner) { return grid.corner({i, j, k}, corner); };
        mesh.elements.push_back({at(0), at(1), at(3), at(2), at(4), at(5), at(7), at(6)});
      }
  detail::add_box_groups(mesh, grid);
  return mesh;
}

PALPATE_INLINE Mesh<Hex8> box_hex8(const Vector3& size, std::array<int, 3> cells, const Vector3& origin) {
  return box_hex8(detail::even_coordinates(origin[0], size[0], cells[0]),
                  detail::even_coordinates(origin[1], size[1], cells[1]),
                  detail::even_coordinates(origin[2], size[2], cells[2]));
}

PALPATE_INLINE Mesh<Hex20> box_hex20(const Vector3& size, std::array<int, 3> cells, const Vector3& origin) {
  return promote<Hex20>(box_hex8(size, cells, origin));
}

PALPATE_INLINE Mesh<Tet10> box_tet10(const Vector3& size, std::array<int, 3> cells, BoxSplit split,
                                     const Vector3& origin) {
  return promote<Tet10>(box_tet4(size, cells, split, origin));
}

}}  // namespace palpate
