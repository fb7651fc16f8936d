// Cells of VTK files, which list nodes, offsets and types in arrays of their own.
#pragma once

#include <palpate/io/detail/vtk_types.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// The cells while they are read; their nodes are in FileMesh::cell_nodes.
struct Cells {
  std::vector<Index> offsets;  ///< starts of the nodes of every cell, and the end of all
  std::vector<Index> places;   ///< in the file
  std::vector<const CellType*> types;
};

/// Adds the type of the next cell. Refuses types that are not read, and a wrong number of nodes.
void add_type(Cells& cells, Index number, const TextReader& in);

/// Adds the cells to a mesh; `regions` has the region number of each, or is empty.
void add_cells(const Cells& cells, const std::vector<int>& regions, FileMesh& mesh);

}}}  // namespace palpate::PALPATE_ABI::io::vtk

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/vtk_cells.ipp>
#endif
