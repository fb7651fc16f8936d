// Reads a mesh from a file of any known format, also VTU and FEBio. Needs pugixml and zlib: link palpate::xml_meshes.
#pragma once

#include <palpate/io/read_mesh.hpp>
#include <palpate/io/xml/febio.hpp>
#include <palpate/io/xml/vtu_file.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Whether a text is XML: the formats below are detected by their first element.
bool is_xml(std::string_view text) noexcept;

/// The parsed text of one VTU or FEBio file, else as io::parse_file.
FileMesh parse_file(std::string_view text, const std::string& name, std::string_view labels = {});

/// The parsed file of any format, with the files that belong to it.
FileMesh read_file_mesh(const std::string& path, std::string_view labels = {});

/// io::parse_mesh, also for VTU and FEBio.
template <Element E>
Mesh<E> parse_mesh(std::string_view text, const std::string& name = "text", const ReadOptions& options = {}) {
  return build_mesh<E>(xml::parse_file(text, name, options.labels), options.scale, options.numbering);
}

/// io::read_mesh, also for VTU and FEBio.
template <Element E>
Mesh<E> read_mesh(const std::string& path, const ReadOptions& options = {}) {
  return build_mesh<E>(xml::read_file_mesh(path, options.labels), options.scale, options.numbering);
}

}}}  // namespace palpate::PALPATE_ABI::io::xml

#include <palpate/io/xml/read_mesh.ipp>
