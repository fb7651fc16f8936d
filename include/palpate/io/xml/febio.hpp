// Reads the meshes of FEBio (*.feb), specification 2.0 to 4.0.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Reads a whole file. Every `<Elements>` is a region and a group, with its name (2.0: elset), else with the name of
/// its material ("material 1") or "part 1"; `<NodeSet>`, `<ElementSet>` and `<Surface>` are groups. Materials, loads
/// and all else are skipped; directions of fibres get a note. Ids are those of the file.
///
/// Errors: bad_file, index_out_of_range, non_finite, unsupported (other versions, element types without a shape here,
/// meshes in other files, parts with instances), with file and line. O(n log n) in the size of the text; memory of
/// about ten times its size.
FileMesh parse_febio(std::string_view text, const std::string& name);

}}}  // namespace palpate::PALPATE_ABI::io::xml

#include <palpate/io/xml/febio.ipp>
