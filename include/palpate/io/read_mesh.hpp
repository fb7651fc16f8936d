// Reads a mesh from a file of any known format.
#pragma once

#include <palpate/io/gmsh_file.hpp>
#include <palpate/io/mesh_builder.hpp>
#include <palpate/io/tetgen.hpp>
#include <palpate/io/veg.hpp>
#include <palpate/io/vtk_legacy.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// What a reader should do beyond reading.
struct ReadOptions {
  double scale = 1.0;                  ///< unit of the file in metres: 1e-3 for millimetres
  MeshNumbering* numbering = nullptr;  ///< receives the ids of the file
};

/// The file formats.
enum class MeshFormat { gmsh, tetgen, vtk, veg, surface, unknown };

/// The format of a text: by its first word, else by the ending of its name.
inline MeshFormat format_of(std::string_view text, const std::string& name) {
  TextReader in(text, name, {'\0', false});
  in.next_line();
  if (in.line().starts_with("# vtk DataFile")) return MeshFormat::vtk;
  if (in.line() == "$MeshFormat" || in.line() == "$NOD") return MeshFormat::gmsh;
  while (in.line().starts_with('#') && in.next_line()) {}
  if (in.line().starts_with("*VERTICES") || in.line().starts_with("*INCLUDE")) return MeshFormat::veg;
  const std::string ending = vtk::lower(std::filesystem::path(name).extension().string());
  for (const auto& [known, format] :
       std::array<std::pair<std::string_view, MeshFormat>, 14>{{{".msh", MeshFormat::gmsh},
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
                                                                {".gltf", MeshFormat::surface}}})
    if (ending == known) return format;
  return MeshFormat::unknown;
}

/// Refuses a file that holds a surface, with the command that meshes it.
[[noreturn]] inline void refuse_surface(const std::string& name) {
  const std::string ending = vtk::lower(std::filesystem::path(name).extension().string());
  std::string hint = "Fill it: tetgen -pq " + name + ", then read the .ele file it writes";
  if (ending == ".stl" || ending == ".ply") hint = fill_command(name);
  if (ending == ".obj" || ending == ".gltf")
    hint = "First: meshio convert " + name + " surface.stl. " + fill_command("surface.stl");
  if (ending == ".edge") hint = "Read the .ele file beside it";
  raise(SetupErrorKind::unsupported, name + ":1: expected solid elements, found a surface", hint);
}

/// Refuses a file of no known format.
[[noreturn]] inline void refuse_unknown(std::string_view text, const std::string& name) {
  TextReader in(text, name);
  in.next_line();
  in.refuse(SetupErrorKind::bad_file, "a Gmsh, TetGen, legacy VTK or VegaFEM mesh", TextReader::quoted(in.line()),
            "meshio and gmsh convert others: meshio convert " + name + " converted.msh");
}

/// The parsed text of one file, whatever its format. TetGen needs several files: see tetgen::parse.
inline FileMesh parse_file(std::string_view text, const std::string& name) {
  switch (format_of(text, name)) {
    case MeshFormat::gmsh:
      return gmsh::parse(text, name);
    case MeshFormat::vtk:
      return vtk::parse(text, name);
    case MeshFormat::veg:
      return veg::parse(text, name, [&](const std::string& other) -> std::string {
        raise(SetupErrorKind::unsupported, name + ": *INCLUDE " + other + " in a text that is no file");
      });
    case MeshFormat::surface:
      refuse_surface(name);
    default:
      refuse_unknown(text, name);
  }
}

/// Reads a mesh from a text that holds a whole file; `name` stands for the file in messages and tells the format where
/// the text does not. For the rest see read_mesh.
template <Element E>
Mesh<E> parse_mesh(std::string_view text, const std::string& name = "text", const ReadOptions& options = {}) {
  return build_mesh<E>(parse_file(text, name), options.scale, options.numbering);
}

/// Reads a file as a mesh of elements E: Gmsh MSH 1, 2.0 to 2.2 and 4.1, ASCII and binary; TetGen .node, .ele and .face
/// (name any of them); legacy VTK, ASCII and binary; VegaFEM .veg. The content decides, then the ending of the name.
///
/// Nodes and elements keep the order of the file: with node ids 1 ... n, id k is node k - 1. Every tagged set of
/// dimension 0 to 3 (physical group, boundary marker, region number, set of elements) becomes a group with its nodes,
/// faces (dimension 2) and elements (dimension 3); names used in several dimensions share one group. Tags without a
/// name are called "volume 1", "surface 2", "curve 3", "point 4"; the tag 0 is none. Every tagged volume that holds
/// elements is a region, numbered by rising tag; an element of several volumes belongs to the region of the lowest tag
/// and to all the groups; elements of none form the region "body". Nodes inside an element are brought from the order
/// of the format to that of E.
///
/// Throws SetupError bad_file, index_out_of_range, count_too_large, non_finite or unsupported (other versions,
/// partitions, solids other than E, a surface without solids: with the command that meshes it), all with file and line
/// (in binary data: byte), and empty_mesh. Geometry is not judged here. Linear time; memory of about three times the
/// size of the file (1e6 tetrahedra in 50 MB of MSH 2: 0.3 s of processor time). Counts are compared with the size of
/// the file before anything is allocated.
template <Element E>
Mesh<E> read_mesh(const std::string& path, const ReadOptions& options = {}) {
  const std::string ending = vtk::lower(std::filesystem::path(path).extension().string());
  if (ending == ".node" || ending == ".ele" || ending == ".face")
    return build_mesh<E>(tetgen::read(path), options.scale, options.numbering);
  const std::string text = read_file(path);
  if (format_of(text, path) == MeshFormat::veg) return build_mesh<E>(veg::read(path), options.scale, options.numbering);
  return parse_mesh<E>(text, path, options);
}

/// The same with the scale and the numbering alone.
template <Element E>
Mesh<E> read_mesh(const std::string& path, double scale, MeshNumbering* numbering = nullptr) {
  return read_mesh<E>(path, ReadOptions{scale, numbering});
}

}}}  // namespace palpate::io
