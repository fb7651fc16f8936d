// Definitions of read_mesh.hpp.
#pragma once

#include <palpate/io/xml/read_mesh.hpp>

#include <fstream>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

inline bool is_xml(std::string_view text) noexcept {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '<';
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
