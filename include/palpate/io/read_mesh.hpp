// Reads a mesh from a file of any known format.
#pragma once

#include <palpate/io/abaqus.hpp>
#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/gmsh_file.hpp>
#include <palpate/io/detail/mesh_builder.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/medit.hpp>
#include <palpate/io/tetgen.hpp>
#include <palpate/io/veg.hpp>
#include <palpate/io/vtk_legacy.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Options of the mesh readers.
struct ReadOptions {
  double scale = 1.0;                  ///< unit of the file in metres: 1e-3 for millimetres
  MeshNumbering* numbering = nullptr;  ///< receives the ids of the file
  /// The cell array of a VTK or VTU file with the labels of the regions, whole numbers; "elementary" in a Gmsh file
  /// takes the elementary tags instead of the physical ones. Empty: what the format provides.
  std::string labels{};
};

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
#include <palpate/io/read_mesh.ipp>
#endif
