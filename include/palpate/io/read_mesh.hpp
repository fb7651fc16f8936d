// Reads a mesh from a file of any known format: the reader of every format, and read_mesh, which detects the format.
#pragma once

#include <palpate/io/read_msh.hpp>

#include <functional>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace tetgen {

/// The texts of the files of one mesh; `name` is their common name without extensions.
struct Texts {
  std::string name;
  std::string_view node, ele, face;  ///< face may be empty
};

/// Reads the files x.node with x.ele and, if it exists, x.face. Ids count from 0 or 1, depending on the first node.
/// Tags are boundary markers and region attributes: groups "point 1", "surface 7", "volume 3". Errors: bad_file,
/// index_out_of_range, count_too_large, non_finite, unsupported, with file and line. Linear in the size of the texts.
FileMesh parse(const Texts& texts);

/// Reads the files of the mesh to which x.node, x.ele or x.face belongs.
FileMesh read(const std::string& path);

}  // namespace tetgen

namespace medit {

/// Reads a whole Medit file (*.mesh and *.meshb), as mmg, CGAL, TetGen, FreeFEM, Gmsh and fTetWild write them: text, or
/// binary of either byte order, versions 1 to 4. References of vertices, edges, faces and solids other than 0 are tags:
/// groups "point 4", "curve 3", "surface 2" and regions "volume 1". Sections may have any order, those of cells may be
/// repeated; those without cells are skipped. Second-order nodes must be in the order of VTK. A text without End gets a
/// note.
///
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported (two dimensions, other orders of
/// nodes), with file and line, in binary files with the byte. Linear in the size of the text; counts are compared with
/// it before anything is allocated.
FileMesh parse(std::string_view text, const std::string& name);

}  // namespace medit

namespace vtk {

/// Reads a whole legacy VTK file (*.vtk): an unstructured grid of version 1 to 5.1, ASCII or binary. The region numbers
/// are the cell array `labels`, if it is not empty, else the first of those that other programs write
/// (detail/vtk_attributes.hpp); real numbers must be whole. Cells with a number other than 0 are in the groups "volume
/// 3", "surface 2" and so on. Without region numbers, arrays that look like labels are noted. Errors: bad_file,
/// index_out_of_range, count_too_large, non_finite, unsupported, with file and line (in binary data: byte). Linear in
/// the size of the text.
FileMesh parse(std::string_view text, const std::string& name, std::string_view labels = {});

}  // namespace vtk

namespace veg {

/// Returns the text of an included file; throws SetupError if it cannot be read.
using Include = std::function<std::string(const std::string& name)>;

/// Reads a VegaFEM file (*.veg); `include` provides the files it includes. Every set is a group with its elements; the
/// set of every *REGION is a region; elements without a region form the region "body". Errors: bad_file,
/// index_out_of_range, non_finite, unsupported, with file and line. Linear in the size of the texts, apart from the
/// number of regions.
FileMesh parse(std::string_view text, const std::string& name, Include include);

/// Reads a file and those it includes, which must be in its folder.
FileMesh read(const std::string& path);

}  // namespace veg

namespace abaqus {

/// Reads a whole file of Abaqus or CalculiX (*.inp): *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE, *SOLID SECTION, and one
/// *PART with one *INSTANCE, which may be translated; other keywords are skipped. Every set and surface is a group,
/// except those that are marked INTERNAL. The set of every *SOLID SECTION is a region; without sections the ELSET of
/// every *ELEMENT. If the part and the assembly have a set of one name, that of the part is called "part.name".
/// Springs, masses and connectors are skipped.
///
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported (other element types, *INCLUDE,
/// keywords that generate nodes, several instances), with file and line. O(n log n) in the size of the text.
FileMesh parse(std::string_view text, const std::string& name);

}  // namespace abaqus

/// The file formats.
enum class MeshFormat { gmsh, tetgen, medit, vtk, veg, abaqus, surface, unknown };

/// The format of a text: by its first word, else by the extension of its name. Medit files are known by their first
/// word alone: other programs use the extension .mesh too.
MeshFormat format_of(std::string_view text, const std::string& name);

/// The parsed text of one file of any format except TetGen. TetGen needs several files: see tetgen::parse.
FileMesh parse_file(std::string_view text, const std::string& name, std::string_view labels = {});

/// The parsed file of any format, with the files that belong to it.
FileMesh read_file_mesh(const std::string& path, std::string_view labels = {});

/// Reads a mesh from a text with the content of a whole file; `name` is the file name in messages, and its extension
/// gives the format if the text does not. For the rest see read_mesh.
template <Element E>
Mesh<E> parse_mesh(std::string_view text, const std::string& name = "text", const ReadOptions& options = {}) {
  return build_mesh<E>(parse_file(text, name, options.labels), options.scale, options.numbering);
}

/// Reads a file as a mesh of elements E: Gmsh MSH 1, 2.0 to 2.2 and 4.1, ASCII and binary; TetGen .node, .ele and .face
/// (name any of them); Medit .mesh and .meshb; legacy VTK, ASCII and binary; VegaFEM .veg; Abaqus and CalculiX .inp.
/// The format is detected from the content, then from the extension of the name.
///
/// Nodes and elements keep the order of the file: with node ids 1 ... n, id k is node k - 1. Every tagged set of
/// dimension 0 to 3 (physical group, boundary marker, region number, set of elements) becomes a group with its nodes,
/// faces (dimension 2) and elements (dimension 3); sets with the same name in several dimensions share one group. Tags
/// without a name are called "volume 1", "surface 2", "curve 3", "point 4"; the tag 0 means no tag. Every tagged volume
/// that contains elements is a region, numbered in ascending order of the tags; an element of several volumes belongs
/// to the region of the lowest tag and to all the groups; elements without a volume form the region "body". The nodes
/// of an element are reordered from the order of the format to that of E.
///
/// Throws SetupError bad_file, index_out_of_range, count_too_large, non_finite or unsupported (other versions,
/// partitions, solids other than E, a surface without solids: with the command that meshes it), all with file and line
/// (in binary data: byte), and empty_mesh. The geometry is not checked here. Linear time; memory of about three times
/// the size of the file (1e6 tetrahedra in 50 MB of MSH 2: 0.3 s of processor time). Counts are compared with the size
/// of the file before anything is allocated.
template <Element E>
Mesh<E> read_mesh(const std::string& path, const ReadOptions& options = {}) {
  return build_mesh<E>(read_file_mesh(path, options.labels), options.scale, options.numbering);
}

/// The same with scale and numbering as arguments.
template <Element E>
Mesh<E> read_mesh(const std::string& path, double scale, MeshNumbering* numbering = nullptr) {
  return read_mesh<E>(path, ReadOptions{scale, numbering, {}});
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/abaqus.ipp>
#include <palpate/io/medit.ipp>
#include <palpate/io/read_mesh.ipp>
#include <palpate/io/tetgen.ipp>
#include <palpate/io/veg.ipp>
#include <palpate/io/vtk_legacy.ipp>
#endif
