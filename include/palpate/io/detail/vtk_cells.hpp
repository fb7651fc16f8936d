// Cells of VTK files, which list nodes, offsets and types in arrays of their own.
#pragma once

#include <palpate/io/detail/tag_sets.hpp>
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

inline void add_type(Cells& cells, Index number, const TextReader& in) {
  const std::size_t c = cells.types.size();
  cells.types.push_back(find_cell_type(number));
  const CellType* type = cells.types.back();
  if (type == nullptr)
    in.refuse(SetupErrorKind::unsupported, "a cell type of first or second order", {"'", number, "'"});
  const Index nodes = cells.offsets[c + 1] - cells.offsets[c];
  const ShapeFacts& shape = facts(type->shape);
  if (type->repeats ? nodes < shape.nodes : nodes != shape.nodes)
    in.refuse(SetupErrorKind::bad_file, {shape.nodes, " nodes for a ", shape.name}, {nodes, " in cell ", c});
}

inline void add_cells(const Cells& cells, const std::vector<int>& regions, FileMesh& mesh) {
  TagSets sets;
  std::vector<NodeId> all;
  all.swap(mesh.cell_nodes);
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    const std::uint32_t set = sets.find_or_add(mesh, regions.empty() ? 0 : regions[c]);
    const CellType& type = *cells.types[c];
    const Index nodes = facts(type.shape).nodes;
    for (Index a = cells.offsets[c]; a + nodes <= cells.offsets[c + 1];
         ++a) {  // once, except for poly-lines and -vertices
      mesh.cell_nodes.insert(mesh.cell_nodes.end(), all.begin() + a, all.begin() + a + nodes);
      mesh.add_cell(static_cast<Index>(c), cells.places[c], type.shape, set, type.order);
    }
  }
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
