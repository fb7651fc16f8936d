// Definitions of read_mesh.hpp.
#pragma once

#include <palpate/io/detail/labels.hpp>
#include <palpate/io/detail/medit_source.hpp>
#include <palpate/io/detail/vtk_numbers.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/read_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

inline bool has_ending(const std::string& name, std::string_view ending) {
  return vtk::same_word(ending_of(name), ending);
}

PALPATE_COLD inline MeshFormat format_of_ending(const std::string& name) {
  struct Ending {
    std::string_view text;
    MeshFormat format;
  };
  constexpr std::array<Ending, 15> endings{{{".msh", MeshFormat::gmsh},
                                            {".inp", MeshFormat::abaqus},
                                            {".vtk", MeshFormat::vtk},
                                            {".veg", MeshFormat::veg},
                                            {".node", MeshFormat::tetgen},
                                            {".ele", MeshFormat::tetgen},
                                            {".face", MeshFormat::tetgen},
                                            {".stl", MeshFormat::surface},
                                            {".obj", MeshFormat::surface},
                                            {".ply", MeshFormat::surface},
                                            {".off", MeshFormat::surface},
                                            {".poly", MeshFormat::surface},
                                            {".smesh", MeshFormat::surface},
                                            {".edge", MeshFormat::surface},
                                            {".gltf", MeshFormat::surface}}};
  for (const Ending& known : endings)
    if (has_ending(name, known.text)) return known.format;
  return MeshFormat::unknown;
}

/// Refuses a file that contains a surface, with the command that meshes it.
[[noreturn]] PALPATE_COLD inline void refuse_surface(const std::string& name) {
  std::string hint = joined({"Fill it: tetgen -pq ", name, ", then read the .ele file it writes"});
  if (has_ending(name, ".stl") || has_ending(name, ".ply")) hint = fill_command(name);
  if (has_ending(name, ".obj") || has_ending(name, ".gltf"))
    hint = joined({"First: meshio convert ", name, " surface.stl. ", fill_command("surface.stl")});
  if (has_ending(name, ".edge")) hint = "Read the .ele file of the same mesh";
  refuse(SetupErrorKind::unsupported, {name, ":1: expected solid elements, found a surface"}, hint);
}

/// The commands that convert a file of no known format: Gmsh's for what only Gmsh reads, else that of meshio.
PALPATE_COLD inline std::string conversion_hint(const std::string& name) {
  constexpr std::array<std::string_view, 5> meshes{".unv", ".med", ".cgns", ".bdf", ".nas"};
  for (const std::string_view ending : meshes)
    if (has_ending(name, ending)) return joined({"Convert it: gmsh ", name, " -save -format msh41 -o converted.msh"});
  constexpr std::array<std::string_view, 6> geometries{".step", ".stp", ".iges", ".igs", ".brep", ".geo"};
  for (const std::string_view ending : geometries)
    if (has_ending(name, ending)) return joined({"Mesh it: gmsh ", name, " -3 -format msh41 -o solid.msh"});
  constexpr std::array<std::string_view, 3> decks{".k", ".key", ".cdb"};
  for (const std::string_view ending : decks)
    if (has_ending(name, ending)) return "Export it for Abaqus or Nastran from the program that wrote it";
  return joined({"meshio and gmsh convert others: ", meshio_command(name)});
}

/// Refuses a file of no known format.
[[noreturn]] PALPATE_COLD inline void refuse_unknown(std::string_view text, const std::string& name) {
  TextReader in(text, name);
  in.next_line();
  if (has_ending(name, ".vtu") || has_ending(name, ".feb"))
    refuse(SetupErrorKind::unsupported, {name, ":1: expected a file without XML, found ", in_quotes(in.line())},
           {"Call io::xml::read_mesh (palpate::xml_meshes), or convert it: ", meshio_command(name)});
  if (in.line().starts_with("MFEM "))
    in.refuse(SetupErrorKind::unsupported, "a Medit mesh", "one of MFEM", "Write it with mfem::Mesh::PrintVTK");
  in.refuse(SetupErrorKind::bad_file, "a Gmsh, TetGen, Medit, legacy VTK, VegaFEM or Abaqus mesh", in_quotes(in.line()),
            conversion_hint(name));
}

/// Include function for a text that is not a file: refuses every included file.
struct RefuseInclude {
  std::string name;
  [[noreturn]] std::string operator()(const std::string& other) const {
    refuse(SetupErrorKind::unsupported, {name, ": *INCLUDE ", other, " is not possible in a text without a file"});
  }
};

}  // namespace detail

PALPATE_COLD PALPATE_INLINE MeshFormat format_of(std::string_view text, const std::string& name) {
  if (medit::is_binary(text)) return MeshFormat::medit;
  TextReader in(text, name, {'\0', false});
  in.next_line();
  if (in.line().starts_with("# vtk DataFile")) return MeshFormat::vtk;
  if (in.line() == "$MeshFormat" || in.line() == "$NOD" || in.line() == "$Comments") return MeshFormat::gmsh;
  while (in.line().starts_with('#') && in.next_line()) {}
  if (in.line().starts_with("MeshVersionFormatted")) return MeshFormat::medit;
  if (in.line().starts_with('*') && detail::has_ending(name, ".inp")) return MeshFormat::abaqus;
  if (in.line().starts_with("*KEYWORD")) return MeshFormat::unknown;  // LS-DYNA
  if (in.line().starts_with("*VERTICES") || in.line().starts_with("*INCLUDE")) return MeshFormat::veg;
  if (in.line().starts_with('*')) return MeshFormat::abaqus;
  return detail::format_of_ending(name);
}

PALPATE_INLINE FileMesh parse_file(std::string_view text, const std::string& name, std::string_view labels) {
  const MeshFormat format = format_of(text, name);
  if (format != MeshFormat::gmsh && format != MeshFormat::vtk) refuse_labels(labels, name);
  switch (format) {
    case MeshFormat::gmsh:
      return gmsh::parse(text, name, labels);
    case MeshFormat::vtk:
      return vtk::parse(text, name, labels);
    case MeshFormat::medit:
      return medit::parse(text, name);
    case MeshFormat::veg:
      return veg::parse(text, name, detail::RefuseInclude{name});
    case MeshFormat::abaqus:
      return abaqus::parse(text, name);
    case MeshFormat::surface:
      detail::refuse_surface(name);
    default:
      detail::refuse_unknown(text, name);
  }
}

PALPATE_INLINE FileMesh read_file_mesh(const std::string& path, std::string_view labels) {
  if (detail::format_of_ending(path) == MeshFormat::tetgen) {
    refuse_labels(labels, path);
    return tetgen::read(path);
  }
  const std::string text = read_file(path);
  if (format_of(text, path) != MeshFormat::veg) return parse_file(text, path, labels);
  refuse_labels(labels, path);
  return veg::read(path);
}

}}}  // namespace palpate::PALPATE_ABI::io
