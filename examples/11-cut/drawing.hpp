// A drawing of the remaining organ, from above and a little from the front; cut surfaces in red.
#pragma once

#include <palpate/cut.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/Geometry>

#include <cstdio>
#include <set>

namespace cut_example {

using namespace palpate;
using Organ = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

/// The supported part of the organ, with the displacement of its nodes [m].
struct Rest {
  Mesh<Tet4> mesh;
  VectorX displacement;
  std::vector<bool> wound;  ///< per face of extract_boundary
  double gape = 0.0;        ///< largest distance between two copies of a node [m]
};

inline Rest rest_of(Organ& tissue) {
  const VectorX u = tissue.displacement();
  Rest rest;
  tissue.read([&](const CutTopology<Tet4>& topology, const CutPhysics<Tet4>& physics) {
    std::vector<NodeId> node_map, origin;
    std::vector<Index> element_map;
    rest.mesh = topology.extract(ElementState::supported, node_map, element_map);
    origin.resize(rest.mesh.positions.size());
    rest.displacement.resize(3 * rest.mesh.node_count());
    for (std::size_t i = 0; i < node_map.size(); ++i) {
      if (node_map[i] < 0) continue;
      const auto node = static_cast<NodeId>(i);
      const NodeId parent = origin[static_cast<std::size_t>(node_map[i])] = topology.origin_of(node);
      rest.displacement.segment<3>(3 * Index{node_map[i]}) = u.segment<3>(3 * Index{node});
      if (!topology.is_made(node) && node_map[static_cast<std::size_t>(parent)] >= 0)
        rest.gape = std::max(rest.gape, (u.segment<3>(3 * Index{node}) - u.segment<3>(3 * Index{parent})).norm());
    }
    for (Vector3& x : rest.mesh.positions) x += tissue.origin();
    std::set<std::array<NodeId, 3>> skin;
    for (const auto& face : extract_boundary<Tet4>(physics.body.mesh)) {
      const auto key = face.key();
      skin.insert({key[0], key[1], key[2]});
    }
    for (const auto& face : extract_boundary<Tet4>(rest.mesh)) {
      std::array<NodeId, 3> key{};
      for (std::size_t a = 0; a < 3; ++a) key[a] = origin[static_cast<std::size_t>(face.nodes[a])];
      std::ranges::sort(key);
      rest.wound.push_back(!skin.contains(key));
    }
  });
  return rest;
}

/// An SVG element of 200 x 140 mm, farthest faces first.
inline std::string draw(const Rest& rest) {
  struct Face {
    double depth;
    std::string svg;
  };
  std::vector<Face> faces;
  std::size_t number = 0;
  for (const auto& face : extract_boundary<Tet4>(rest.mesh)) {
    const bool wound = rest.wound[number++];
    std::array<Vector3, 3> x;
    for (std::size_t a = 0; a < 3; ++a) {
      const Index node = face.nodes[a];
      const Vector3 p = 1e3 * (rest.mesh.position(node) + rest.displacement.segment<3>(3 * node));
      x[a] = {p[0], -0.87 * p[1] - 0.5 * p[2], 0.87 * p[2] - 0.5 * p[1]};
    }
    const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    if (normal[2] > 0.0) continue;  // y points down on the page: facing away
    const double light = 0.45 - 0.55 * normal[2];
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" fill=\"rgb(%d,%d,%d)\"/>",
                  x[0][0], x[0][1], x[1][0], x[1][1], x[2][0], x[2][1], static_cast<int>((wound ? 230 : 170) * light),
                  static_cast<int>((wound ? 40 : 110) * light), static_cast<int>((wound ? 40 : 100) * light));
    faces.push_back({x[0][2] + x[1][2] + x[2][2], text.data()});
  }
  std::ranges::sort(faces, {}, &Face::depth);
  std::string svg = "<svg viewBox=\"-110 -100 220 150\" width=\"440\">";
  for (const Face& f : faces) svg += f.svg;
  return svg + "</svg>";
}

}  // namespace cut_example
