// Reads whole Gmsh files: their format and sections.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

/// Reads a whole file. The regions are the physical volumes; with `labels` "elementary" the elementary tags replace all
/// physical tags and names. Files in which no solid has a physical tag, but several elementary ones, get a note.
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, each with file and line (in binary
/// data: byte). Linear in the size of the text, O(n log n) if node ids are not 1 ... n; counts are compared with the
/// size of the text before anything is allocated.
FileMesh parse(std::string_view text, const std::string& name, std::string_view labels = {});

}}}  // namespace palpate::PALPATE_ABI::io::gmsh

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/gmsh_file.ipp>
#endif
