// Boxes of hexahedra and of quadratic elements.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/mesh.hpp>

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/generators_box.ipp>
#endif
