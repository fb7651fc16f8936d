// Cells of VTK files, which list nodes, offsets and types in arrays of their own, and the types.
#pragma once

#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/tag_sets.hpp>
#include <palpate/io/detail/text_reader.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// A cell type: its number in the file, its shape and the order of its nodes.
struct CellType {
  int number;
  CellShape shape;
  NodeOrder order{};
  bool repeats = false;  ///< any number of nodes: a cell of that shape begins at every node but the last ones
};

/// The types that are read (vtkCellType.h).
inline constexpr std::array cell_types{
    CellType{1, CellShape::point},
    CellType{3, CellShape::line2},
    CellType{21, CellShape::line3},
    CellType{5, CellShape::triangle3},
    CellType{22, CellShape::triangle6},
    CellType{9, CellShape::quadrangle4},
    CellType{8, CellShape::quadrangle4, pixel_quadrangle4},
    CellType{23, CellShape::quadrangle8},
    CellType{28, CellShape::quadrangle9},
    CellType{10, CellShape::tetrahedron4},
    CellType{24, CellShape::tetrahedron10},
    CellType{12, CellShape::hexahedron8},
    CellType{11, CellShape::hexahedron8, voxel_hexahedron8},
    CellType{25, CellShape::hexahedron20},
    CellType{29, CellShape::hexahedron27},
    CellType{13, CellShape::prism6},
    CellType{26, CellShape::prism15},
    CellType{14, CellShape::pyramid5},
    CellType{27, CellShape::pyramid13},
    CellType{2, CellShape::point, {}, true},
    CellType{4, CellShape::line2, {}, true},
};

/// The type of that number, or nullptr.
constexpr const CellType* find_cell_type(Index number) noexcept {
  for (const CellType& t : cell_types)
    if (t.number == number) return &t;
  return nullptr;
}

/// The first type of that shape.
constexpr const CellType& cell_type_of(CellShape shape) noexcept {
  const CellType* t = cell_types.data();
  while (t->shape != shape) ++t;
  return *t;
}

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
