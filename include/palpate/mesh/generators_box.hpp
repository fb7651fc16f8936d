// Boxes of hexahedra and of quadratic elements.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/promote.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Box of hexahedra with nodes at every combination of the given coordinates [m], which must be ascending. Nodes,
/// groups, region and refusals as in box_tet4.
Mesh<Hex8> box_hex8(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z);

/// Box of `size` [m] from `origin`, in equal cells.
Mesh<Hex8> box_hex8(const Vector3& size, std::array<int, 3> cells, const Vector3& origin = Vector3::Zero());

/// The same cells as Hex20.
Mesh<Hex20> box_hex20(const Vector3& size, std::array<int, 3> cells, const Vector3& origin = Vector3::Zero());

/// The tetrahedra of box_tet4 as Tet10.
Mesh<Tet10> box_tet10(const Vector3& size, std::array<int, 3> cells, BoxSplit split = BoxSplit::five_mirrored,
                      const Vector3& origin = Vector3::Zero());

inline Mesh<Hex8> box_hex8(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
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

inline Mesh<Hex8> box_hex8(const Vector3& size, std::array<int, 3> cells, const Vector3& origin) {
  return box_hex8(detail::even_coordinates(origin[0], size[0], cells[0]),
                  detail::even_coordinates(origin[1], size[1], cells[1]),
                  detail::even_coordinates(origin[2], size[2], cells[2]));
}

inline Mesh<Hex20> box_hex20(const Vector3& size, std::array<int, 3> cells, const Vector3& origin) {
  return promote<Hex20>(box_hex8(size, cells, origin));
}

inline Mesh<Tet10> box_tet10(const Vector3& size, std::array<int, 3> cells, BoxSplit split, const Vector3& origin) {
  return promote<Tet10>(box_tet4(size, cells, split, origin));
}

}}  // namespace palpate
