// Reads Gmsh meshes (MSH 2.2 and 4.1, ASCII) with their named groups.
#pragma once

#include <palpate/io/gmsh_builder.hpp>

namespace palpate::inline PALPATE_ABI::io {

/// The ids a mesh file uses: entry i belongs to node i or element i of the mesh.
struct GmshNumbering {
  std::vector<Index> node_tags;
  std::vector<Index> element_tags;
};

/// Reads a mesh from a text that holds a Gmsh file; `name` stands for the file in messages. For the rest see read_mesh.
template <Element E>
Mesh<E> parse_mesh(std::string_view text, const std::string& name = "text", double scale = 1.0,
                   GmshNumbering* numbering = nullptr) {
  if (!(scale > 0.0) || !std::isfinite(scale))
    raise(SetupErrorKind::bad_argument, "a mesh cannot be scaled by " + number(scale));
  TextReader in(text, name);
  gmsh::Data data = gmsh::parse(in);
  gmsh::MeshBuilder<E> builder(data, in);
  Mesh<E> mesh = builder.build(scale);
  if (numbering != nullptr) *numbering = {std::move(data.node_tags), std::move(builder).element_tags()};
  return mesh;
}

/// Reads a Gmsh file (MSH 2.2 or 4.1, ASCII) as a mesh of elements E; `scale` turns its unit into metres (1e-3 for
/// millimetres).
///
/// Nodes and elements keep the order of the file: with node ids 1 ... n, id k is node k - 1. Every physical group of
/// dimension 0 to 3 becomes a group of its name with its nodes, faces (dimension 2) and elements (dimension 3); names
/// used in several dimensions share one group. Every physical volume that holds elements is a region, numbered by
/// rising physical tag; an element of several volumes belongs to the region of the lowest tag and to all the groups;
/// elements of none form the region "body". Physical tags without a name are called "volume 1", "surface 2" and so on.
/// `numbering`, if given, receives the ids of the file.
///
/// Throws SetupError bad_file, index_out_of_range, count_too_large, non_finite or unsupported (MSH 1, 3, 4.0, binary,
/// partitions, solid elements other than E, a surface without solid elements), with file and line, and empty_mesh.
/// Geometry is not judged here. Linear time; memory of about five times the size of the file (1e6 tetrahedra in 50
/// MB: 1.2 s).
template <Element E>
Mesh<E> read_mesh(const std::string& path, double scale = 1.0, GmshNumbering* numbering = nullptr) {
  return parse_mesh<E>(read_file(path), path, scale, numbering);
}

}  // namespace palpate::inline PALPATE_ABI::io
