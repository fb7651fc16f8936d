// Definitions of file_mesh.hpp.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE FileMesh::FileMesh(std::string name) {
  files.push_back(std::move(name));
}

PALPATE_INLINE void FileMesh::add_cell(Index tag, Index place, CellShape shape, std::uint32_t tag_set, NodeOrder order,
                                       std::uint8_t file) {
  const std::size_t count = static_cast<std::size_t>(facts(shape).nodes), first = cell_nodes.size() - count;
  cells.push_back({tag, place, first, tag_set, shape, file});
  if (order.empty()) return;
  std::array<NodeId, 32> read{};
  for (std::size_t k = 0; k < count; ++k) read[k] = cell_nodes[first + k];
  for (std::size_t k = 0; k < count; ++k) cell_nodes[first + k] = read[order[k]];
}

PALPATE_COLD PALPATE_INLINE std::string meshio_command(std::string_view name) {
  return joined({"meshio convert ", name, " converted.vtk"});
}

PALPATE_COLD PALPATE_INLINE std::string fill_command(const std::string& surface) {
  return joined({"Fill it: echo 'Merge \"", surface,
                 "\"; Surface Loop(1) = Surface{:}; Volume(1) = {1}; "
                 "Physical Volume(\"body\") = {1};' > solid.geo && gmsh solid.geo -3 -o solid.msh"});
}

}}}  // namespace palpate::PALPATE_ABI::io
