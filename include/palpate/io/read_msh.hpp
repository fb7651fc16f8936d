// Reads a mesh from a Gmsh file. Other formats: io/read_mesh.hpp.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/file_mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace gmsh {

/// Reads a whole Gmsh file. The regions are the physical volumes; with `labels` "elementary" the elementary tags
/// replace all physical tags and names. Files in which no solid has a physical tag, but several elementary ones, get a
/// note. Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, each with file and line (in
/// binary data: byte). Linear in the size of the text, O(n log n) if node ids are not 1 ... n; counts are compared with
/// the size of the text before anything is allocated.
FileMesh parse(std::string_view text, const std::string& name, std::string_view labels = {});

}  // namespace gmsh

/// The mesh of a parsed file with elements of that layout, for which solid_shape must be valid; `numbering`, if given,
/// receives the ids of the file.
palpate::detail::PlainMesh build_plain_mesh(FileMesh file, const palpate::detail::ElementLayout& element, double scale,
                                            MeshNumbering* numbering);

/// The same as a mesh of E.
template <Element E>
Mesh<E> build_mesh(FileMesh file, double scale, MeshNumbering* numbering) {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  return to_mesh<E>(build_plain_mesh(std::move(file), palpate::detail::element_layout<E>, scale, numbering));
}

/// Options of the mesh readers.
struct ReadOptions {
  double scale = 1.0;                  ///< unit of the file in metres: 1e-3 for millimetres
  MeshNumbering* numbering = nullptr;  ///< receives the ids of the file
  /// The cell array of a VTK or VTU file with the labels of the regions, whole numbers; "elementary" in a Gmsh file
  /// takes the elementary tags instead of the physical ones. Empty: what the format provides.
  std::string labels{};
};

/// Reads a Gmsh file as a mesh of elements E: MSH 1, 2.0 to 2.2 and 4.1, ASCII and binary. As read_mesh
/// (io/read_mesh.hpp), which detects the format; a program that calls only this does not compile the other readers.
/// Throws as read_mesh; another format: bad_file.
template <Element E>
Mesh<E> read_msh(const std::string& path, const ReadOptions& options = {}) {
  return build_mesh<E>(gmsh::parse(read_file(path), path, options.labels), options.scale, options.numbering);
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/gmsh_file.ipp>
#include <palpate/io/detail/mesh_builder.ipp>
#endif
