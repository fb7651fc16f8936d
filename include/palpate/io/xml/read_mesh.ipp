// Definitions of read_mesh.hpp.
#pragma once

#include <palpate/io/xml/read_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

inline bool is_xml(std::string_view text) noexcept {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '<';
}

inline FileMesh parse_file(std::string_view text, const std::string& name) {
  if (!is_xml(text)) return io::parse_file(text, name);
  const std::size_t vtu = text.find("<VTKFile"), febio = text.find("<febio_spec");
  if (vtu < febio) return parse_vtu(text, name);
  if (febio < text.size()) return parse_febio(text, name);
  TextReader in(text, name);
  in.next_line();
  in.refuse(SetupErrorKind::bad_file, "<VTKFile> or <febio_spec>", in_quotes(in.line()),
            {"meshio and gmsh convert others: meshio convert ", name, " converted.msh"});
}

inline FileMesh read_file_mesh(const std::string& path) {
  if (format_of("", path) == MeshFormat::tetgen) return io::read_file_mesh(path);
  const std::string text = read_file(path);
  if (is_xml(text)) return xml::parse_file(text, path);
  return format_of(text, path) == MeshFormat::veg ? io::read_file_mesh(path) : io::parse_file(text, path);
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
