// Two tetrahedra with a named point, a named face and a named volume, in every format, and the result of reading a
// text.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/io/read_mesh.hpp>

#include "catch.hpp"
#include "file_texts.hpp"

#include <filesystem>

namespace test {

/// A file name in the temporary folder, removed at the end.
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string& name) : path((std::filesystem::temp_directory_path() / name).string()) {}
  ~TemporaryFile() { std::filesystem::remove(path); }
};

inline const std::string msh2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 3 "tip"
2 2 "base"
3 1 "tissue"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1.5 1 1
$EndNodes
$Elements
4
1 15 2 3 5 5
2 2 2 2 1 1 3 2
3 4 2 1 1 1 2 3 4
4 4 2 1 1 2 3 4 5
$EndElements
)";

inline const std::string msh4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 3 "tip"
2 2 "base"
3 1 "tissue"
$EndPhysicalNames
$Entities
1 0 1 1
5 1.5 1 1 1 3
1 0 0 0 1 1 0 1 2 0
1 0 0 0 1.5 1 1 1 1 1 1
$EndEntities
$Nodes
2 5 1 5
2 1 0 3
1
2
3
0 0 0
1 0 0
0 1 0
3 1 0 2
4
5
0 0 1
1.5 1 1
$EndNodes
$Elements
3 4 1 4
0 5 15 1
1 5
2 1 2 1
2 1 3 2
3 1 4 2
3 1 2 3 4
4 2 3 4 5
$EndElements
)";

/// With ids that are not 1 ... n, a part, and sets of both levels.
inline const std::string abaqus = R"(*Heading
 two tetrahedra
** the mesh
*Part, name=Body
*Node
 10, 0., 0., 0.
 20, 1., 0.
 40, 0., 1.D0, 0.
 30, , , 1.0E+00
 50, 1.5, 1., 1.
*Element, type=C3D4H,
 elset=tissue
 7, 10, 20, 40,
    30
 9, 20, 40, 30, 50,
*Elset, elset=_base_S1, internal
 7,
*Nset, nset=some, generate
 20, 40, 10
*Solid Section, elset=TISSUE, material=soft
,
*End Part
*Assembly, name=Assembly
*Instance, name=Body-1, part=Body
*End Instance
*Node
 1, 9., 9., 9.
*Nset, nset=tip, instance=Body-1
 50,
*Surface, type=ELEMENT, name=base
 Body-1._base_S1, S1
*End Assembly
)";

/// `text` with the first `from` replaced; fails the test if there is none.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// The sample in every format, by its name.
inline const std::map<std::string, std::string>& samples() {
  static const FileMesh m = palpate::io::gmsh::parse(msh2, "sample");
  static const std::map<std::string, std::string> all{
      {"msh1", msh1(m)},
      {"msh2", msh2},
      {"msh2 binary", msh2_binary(m, false)},
      {"msh2 binary, swapped", msh2_binary(m, true)},
      {"msh4", msh4},
      {"msh4 binary", msh4_binary(m, false)},
      {"msh4 binary, swapped", msh4_binary(m, true)},
      {"tetgen", tetgen(m, 1)},
      {"tetgen from 0", tetgen(m, 0)},
      {"vtk2", vtk(m, 2, false)},
      {"vtk2 binary", vtk(m, 2, true)},
      {"vtk5", vtk(m, 5, false)},
      {"vtk5 binary", vtk(m, 5, true)},
      {"medit", medit(m)},
      {"medit binary", medit_binary(m, 2, false)},
      {"medit binary, swapped", medit_binary(m, 4, true)},
      {"veg", veg(m)},
      {"abaqus", abaqus},
  };
  return all;
}

/// Parses a text as that format ("" is Gmsh). Texts of TetGen contain three files, separated by the byte 0x1F.
inline palpate::io::FileMesh parse_as(const std::string& format, std::string_view text) {
  using namespace palpate::io;
  if (format.starts_with("tetgen")) {
    const std::size_t ele = text.find('\x1f'), face = ele == text.npos ? ele : text.find('\x1f', ele + 1);
    const auto part = [&](std::size_t from, std::size_t to) {
      return from == text.npos ? std::string_view{} : text.substr(from, to - from);
    };
    return palpate::io::tetgen::parse({"mesh", part(0, ele), part(ele == text.npos ? ele : ele + 1, face),
                                       part(face == text.npos ? face : face + 1, text.npos)});
  }
  if (format.starts_with("vtk")) return palpate::io::vtk::parse(text, "mesh");
  if (format.starts_with("veg"))
    return palpate::io::veg::parse(text, "mesh", [](const std::string& name) -> std::string {
      if (name == "itself.veg") return "*INCLUDE itself.veg\n";
      palpate::raise(palpate::SetupErrorKind::bad_file, "no file " + name);
    });
  if (format.starts_with("medit")) return palpate::io::medit::parse(text, "mesh");
  if (format.starts_with("abaqus")) return palpate::io::abaqus::parse(text, "mesh");
  return gmsh::parse(text, "mesh");
}

/// "accepted", or the kind of the refusal. An accepted mesh must be valid.
inline std::string verdict(std::string_view text, const std::string& format = {}) {
  using namespace palpate;
  Mesh<Tet4> mesh;
  try {
    mesh = io::build_mesh<Tet4>(parse_as(format, text), 1.0, nullptr);
  } catch (const SetupError& error) {
    return std::string(to_string(error.kind()));
  }
  const Index n = mesh.node_count();
  bool sound = n > 0 && mesh.element_count() > 0 && mesh.regions.size() == mesh.elements.size();
  for (const auto& x : mesh.positions) sound = sound && x.allFinite();
  for (const auto& element : mesh.elements)
    for (const NodeId i : element) sound = sound && i >= 0 && i < n;
  for (const int r : mesh.regions) sound = sound && r >= 0 && r < mesh.region_count();
  for (const Group& g : mesh.groups.all()) {
    for (const NodeId i : g.nodes) sound = sound && i >= 0 && i < n;
    for (const Index e : g.elements) sound = sound && e >= 0 && e < mesh.element_count();
  }
  return sound ? "accepted" : "unsound";
}

/// The message of the refusal, empty when accepted.
inline std::string complaint(std::string_view text, const std::string& format = {}) {
  try {
    palpate::io::build_mesh<palpate::Tet4>(parse_as(format, text), 1.0, nullptr);
  } catch (const palpate::SetupError& error) {
    return error.what();
  }
  return {};
}

}  // namespace test
