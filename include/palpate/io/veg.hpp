// Reads VegaFEM meshes (*.veg).
#pragma once

#include <palpate/io/file_mesh.hpp>

#include <functional>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

/// Returns the text of an included file; throws SetupError if it cannot be read.
using Include = std::function<std::string(const std::string& name)>;

/// Reads a file; `include` provides the files it includes. Every set is a group with its elements; the set of every
/// *REGION is a region; elements without a region form the region "body". Errors: bad_file, index_out_of_range,
/// non_finite, unsupported, with file and line. Linear in the size of the texts, apart from the number of regions.
FileMesh parse(std::string_view text, const std::string& name, Include include);

/// Reads a file and those it includes, which must be in its folder.
FileMesh read(const std::string& path);

}}}  // namespace palpate::PALPATE_ABI::io::veg

#if PALPATE_HEADER_ONLY
#include <palpate/io/veg.ipp>
#endif
