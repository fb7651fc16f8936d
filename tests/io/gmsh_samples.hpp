// Two tetrahedra with a named point, a named face and a named volume, in both formats, and what a reader says of a
// text.
#pragma once

#include <palpate/io/gmsh.hpp>

#include "catch.hpp"

namespace test {

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

/// `text` with the first `from` replaced; fails the test when there is none.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// "accepted", or the kind of the refusal. Whatever is accepted must be sound.
inline std::string verdict(std::string_view text) {
  using namespace palpate;
  Mesh<Tet4> mesh;
  try {
    mesh = io::parse_mesh<Tet4>(text, "mesh");
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
inline std::string complaint(std::string_view text) {
  try {
    palpate::io::parse_mesh<palpate::Tet4>(text, "mesh");
  } catch (const palpate::SetupError& error) {
    return error.what();
  }
  return {};
}

}  // namespace test
