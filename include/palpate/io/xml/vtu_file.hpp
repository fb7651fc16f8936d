// Reads VTU files (unstructured grids of VTK in XML): text, base64 and raw data, as it is or compressed by zlib.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Reads a whole file with one `<Piece>`, of either byte order. Cells and regions are read as from legacy files, with
/// `labels` the name of the array of regions, see vtk_legacy.hpp. The compressors LZ4 and LZMA are refused, as are
/// several pieces.
///
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, with file and line, in binary data
/// with the byte of the array. Linear in the size of the data. Sizes in the file are compared with the sizes that its
/// points and cells need before anything is allocated; compressed data may grow by `most_expansion`.
FileMesh parse_vtu(std::string_view text, const std::string& name, std::string_view labels = {});

}}}  // namespace palpate::PALPATE_ABI::io::xml

#include <palpate/io/xml/vtu_file.ipp>
