// The content of a mesh file, independent of the element type requested.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/detail/message.hpp>

#include <limits>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

inline constexpr Index max_tag = std::numeric_limits<Index>::max();
inline constexpr Index max_int = std::numeric_limits<int>::max();

/// The name a file gives to the cells of one dimension with one tag.
struct TagName {
  int dimension;
  int tag;
  std::string name;
};

/// A cell of the file. Its nodes are `facts(shape).nodes` entries of FileMesh::cell_nodes from `first_node` on.
struct FileCell {
  Index tag;       ///< its id in the file
  Index location;  ///< its place in the file, for location_text
  std::size_t first_node;
  std::uint32_t tag_set;  ///< entry of FileMesh::tag_sets
  CellShape shape;
  std::uint8_t file;  ///< entry of FileMesh::files
};

/// A parsed file of any format. Nodes count from zero; those of a cell are in VTK's order. A tag puts a cell into the
/// group of its dimension and tag; the lowest tag of a solid cell is its region.
struct FileMesh {
  explicit FileMesh(std::string name);

  std::vector<std::string> files;  ///< names, for messages
  std::vector<Vector3> positions;
  std::vector<Index> node_tags;  ///< ids in the file
  std::vector<TagName> names;
  std::vector<std::vector<int>> tag_sets{{}};  ///< entry 0 is the empty set
  std::vector<FileCell> cells;
  std::vector<NodeId> cell_nodes;
  bool repeats_cells = false;                   ///< a cell is listed once per group it is in, in consecutive lines
  int last_region = static_cast<int>(max_int);  ///< tags above it define groups but no regions
  std::vector<std::string> notes;               ///< for Mesh::notes: a sentence each, without the name of the file

  /// Adds a cell whose nodes are at the end of cell_nodes, in the order of the file.
  void add_cell(Index tag, Index place, CellShape shape, std::uint32_t tag_set, NodeOrder order, std::uint8_t file = 0);
};

/// The ids a mesh file uses: entry i belongs to node i or element i of the mesh.
struct MeshNumbering {
  std::vector<Index> node_tags;
  std::vector<Index> element_tags;
};

/// Largest number of groups in a mesh file; with more, the tags are assumed to have another meaning.
inline constexpr std::size_t max_groups = 10000;

/// The command that converts a mesh of another format to one that is read here: meshio would write an ANSYS file to a
/// name that ends with .msh.
std::string meshio_command(std::string_view name);

/// The command that fills a closed surface with tetrahedra.
std::string fill_command(const std::string& surface);

inline FileMesh::FileMesh(std::string name) {
  files.push_back(std::move(name));
}

inline void FileMesh::add_cell(Index tag, Index place, CellShape shape, std::uint32_t tag_set, NodeOrder order,
                               std::uint8_t file) {
  const std::size_t count = static_cast<std::size_t>(facts(shape).nodes), first = cell_nodes.size() - count;
  cells.push_back({tag, place, first, tag_set, shape, file});
  if (order.empty()) return;
  std::array<NodeId, 32> read{};
  for (std::size_t k = 0; k < count; ++k) read[k] = cell_nodes[first + k];
  for (std::size_t k = 0; k < count; ++k) cell_nodes[first + k] = read[order[k]];
}

PALPATE_COLD inline std::string meshio_command(std::string_view name) {
  return joined({"meshio convert ", name, " converted.vtk"});
}

PALPATE_COLD inline std::string fill_command(const std::string& surface) {
  return joined({"Fill it: echo 'Merge \"", surface,
                 "\"; Surface Loop(1) = Surface{:}; Volume(1) = {1}; "
                 "Physical Volume(\"body\") = {1};' > solid.geo && gmsh solid.geo -3 -o solid.msh"});
}

}}}  // namespace palpate::PALPATE_ABI::io
