// The sets, sections and surfaces of an Abaqus file as groups and regions.
#pragma once

#include <palpate/io/detail/abaqus_sets.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// A line of a *SURFACE: a face of an element or of all elements of a set, or a node or a set of nodes.
struct SurfacePart {
  Index id, set;  ///< id of an element or a node, or -1 and the set
  int face;       ///< 0 for S1; shell for the element itself; of_nodes for nodes
  Index line;

  static constexpr int shell = -1, of_nodes = -2;
};

struct Surface {
  std::string name;
  std::vector<SurfacePart> parts;
};

/// All that defines groups.
struct Groups {
  Sets nodes, elements;
  std::vector<Index> sections;  ///< sets of elements
  std::vector<Surface> surfaces;

  std::vector<Index> element_blocks;  ///< the sets of *ELEMENT lines: the regions if there are no sections
};

/// Adds tags, names and the cells of faces and nodes to a mesh with all its nodes and elements. `cells` has the cell of
/// every element, -1 for one without a shape. Section r is region r with the tag r + 1; an element of two sections
/// belongs to the first.
void add_groups(Groups& groups, const IdTable& nodes, const IdTable& elements, std::span<const Index> cells,
                const TextReader& in, FileMesh& mesh);

}}}  // namespace palpate::PALPATE_ABI::io::abaqus

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/abaqus_groups.ipp>
#endif
