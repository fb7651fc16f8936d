// The two cubes of the thesis, the smallest mesh with two regions.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

#include <string_view>
#include <utility>
#include <vector>

namespace test {

using namespace palpate;

/// The two unit cubes of the thesis side by side along x: 12 nodes, 10 elements, the second cube mirrored. Groups
/// "fixed" (x = 0), "end" (x = 2), "side" (the rest of the surface), all with outward faces, and "load_point", the node
/// (2, 1, 1). Regions "cube_a", "cube_b".
inline Mesh<Tet4> two_cubes() {
  Mesh<Tet4> mesh;
  for (double x : {0.0, 1.0, 2.0})
    for (double y : {0.0, 1.0})
      for (double z : {0.0, 1.0}) mesh.positions.emplace_back(x, y, z);
  mesh.elements = {{0, 4, 2, 1},  {6, 2, 4, 7},  {5, 4, 1, 7}, {3, 7, 1, 2},   {4, 2, 1, 7},
                   {8, 10, 4, 9}, {6, 4, 10, 7}, {5, 9, 4, 7}, {11, 9, 7, 10}, {4, 9, 10, 7}};
  mesh.regions = {0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
  mesh.region_names = {"cube_a", "cube_b"};
  mesh.groups.get_or_add("load_point", 0).nodes = {11};
  const auto add = [&](std::string_view name, std::vector<std::vector<NodeId>> faces) {
    Group& group = mesh.groups.get_or_add(name, 2);
    for (const auto& face : faces) group.nodes.insert(group.nodes.end(), face.begin(), face.end());
    group.faces = std::move(faces);
  };
  add("fixed", {{0, 1, 2}, {3, 2, 1}});
  add("end", {{10, 9, 8}, {9, 10, 11}});
  // clang-format off
  add("side", {{2, 4, 0},  {4, 1, 0},  {4, 2, 6},  {2, 7, 6},  {1, 4, 5},  {5, 7, 1},  {1, 7, 3},   {7, 2, 3},
               {4, 10, 8}, {8, 9, 4},  {10, 4, 6}, {6, 7, 10}, {4, 9, 5},  {9, 7, 5},  {7, 9, 11},  {11, 10, 7}});
  // clang-format on
  mesh.groups.tidy();
  return mesh;
}

}  // namespace test
