// Reads legacy VTK files (*.vtk): unstructured grids of versions 1 to 5.1, ASCII and binary.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// Reads a whole file. Cells with a region number other than 0 are in the groups "volume 3", "surface 2" and so on.
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, with file and line (in binary data:
/// byte). Linear in the size of the text.
FileMesh parse(std::string_view text, const std::string& name);

}}}  // namespace palpate::PALPATE_ABI::io::vtk

#if PALPATE_HEADER_ONLY
#include <palpate/io/vtk_legacy.ipp>
#endif
