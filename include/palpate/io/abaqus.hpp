// Reads Abaqus and CalculiX meshes (*.inp).
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// Reads a whole file: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE, *SOLID SECTION, and one *PART with one *INSTANCE,
/// which may be translated; other keywords are skipped. Every set and surface is a group, except those that are marked
/// INTERNAL. The set of every *SOLID SECTION is a region; without sections the ELSET of every *ELEMENT. If the part and
/// the assembly have a set of one name, that of the part is called "part.name". Springs, masses and connectors are
/// skipped.
///
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported (other element types, *INCLUDE,
/// keywords that generate nodes, several instances), with file and line. O(n log n) in the size of the text.
FileMesh parse(std::string_view text, const std::string& name);

}}}  // namespace palpate::PALPATE_ABI::io::abaqus

#if PALPATE_HEADER_ONLY
#include <palpate/io/abaqus.ipp>
#endif
