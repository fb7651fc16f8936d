// Reads legacy VTK files (*.vtk): unstructured grids of versions 1 to 5.1, ASCII and binary.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// Reads a whole file. The region numbers are the cell array `labels`, if it is not empty, else the first of those that
/// other programs write (detail/vtk_attributes.hpp); real numbers must be whole. Cells with a number other than 0 are
/// in the groups "volume 3", "surface 2" and so on. Without region numbers, arrays that look like labels are noted.
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, with file and line (in binary data:
/// byte). Linear in the size of the text.
FileMesh parse(std::string_view text, const std::string& name, std::string_view labels = {});

}}}  // namespace palpate::PALPATE_ABI::io::vtk

#if PALPATE_HEADER_ONLY
#include <palpate/io/vtk_legacy.ipp>
#endif
