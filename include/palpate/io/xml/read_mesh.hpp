// Reads a mesh from a file of any known format, also VTU and FEBio. Needs pugixml and zlib: link palpate::xml_meshes.
#pragma once

#include <palpate/io/read_mesh.hpp>
#include <palpate/io/xml/febio.hpp>
#include <palpate/io/xml/vtu_file.hpp>

#include <fstream>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Whether a text is XML: the formats below are detected by their first element.
inline bool is_xml(std::string_view text) noexcept {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '<';
}

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

inline FileMesh parse_file(std::string_view text, const std::string& name, std::string_view labels) {
  if (!is_xml(text)) return io::parse_file(text, name, labels);
  const std::size_t vtu = text.find("<VTKFile"), febio = text.find("<febio_spec");
  if (vtu < febio) return parse_vtu(text, name, labels);
  refuse_labels(labels, name);
  if (febio < text.size()) return parse_febio(text, name);
  TextReader in(text, name);
  in.next_line();
  in.refuse(SetupErrorKind::bad_file, "<VTKFile> or <febio_spec>", in_quotes(in.line()),
            {"meshio and gmsh convert others: ", meshio_command(name)});
}

inline FileMesh read_file_mesh(const std::string& path, std::string_view labels) {
  constexpr std::size_t enough = 4096;  // to reach the first tag
  std::string head(enough, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(enough));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return is_xml(head) ? xml::parse_file(read_file(path), path, labels) : io::read_file_mesh(path, labels);
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
