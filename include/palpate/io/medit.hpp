// Reads Medit meshes (*.mesh and *.meshb), as mmg, CGAL, TetGen, FreeFEM, Gmsh and fTetWild write them.
#pragma once

#include <palpate/io/detail/medit_source.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::medit {

/// Reads a whole file: text, or binary of either byte order, versions 1 to 4. References of vertices, edges, faces and
/// solids other than 0 are tags: groups "point 4", "curve 3", "surface 2" and regions "volume 1". Sections may have any
/// order, those of cells may be repeated; those without cells are skipped. Second-order nodes must be in the order of
/// VTK. A text without End gets a note.
///
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported (two dimensions, other orders of
/// nodes), with file and line, in binary files with the byte. Linear in the size of the text; counts are compared with
/// it before anything is allocated.
FileMesh parse(std::string_view text, const std::string& name);

}}}  // namespace palpate::PALPATE_ABI::io::medit

#if PALPATE_HEADER_ONLY
#include <palpate/io/medit.ipp>
#endif
