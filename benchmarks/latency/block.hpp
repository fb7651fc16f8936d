// Blocks with the same touchable patch and different numbers of elements.
#pragma once

#include <array>
#include <cmath>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/scene.hpp>
#include <vector>

namespace latency {

/// 32 x 32 x 16 mm. In the middle of the top 16 x 16 cells of 1 mm, one layer deep: 289 touchable nodes, the same in
/// every block. Around and below them `beside` and `below` cells that grow geometrically.
struct Block {
  int beside, below;
  int touched = 16;  ///< cells across that may be touched, in the middle
};
/// 3.9, 9.6, 17 and 28 thousand tetrahedra.
inline constexpr std::array<Block, 4> blocks{{{1, 1}, {2, 3}, {3, 5}, {4, 7}}};

inline constexpr double cell = 1e-3, patch = 16e-3, half_width = 16e-3, height = 16e-3;  // [m]
inline constexpr palpate::LinearElastic tissue{.youngs_modulus = 10e3, .poisson_ratio = 0.45, .density = 1000.0};

/// Distances from 0: `cells` steps, growing geometrically from the first after `cell`, that end at `total`.
inline std::vector<double> growing(double total, int cells) {
  const auto length = [&](double ratio) {
    double sum = 0.0, step = cell;
    for (int i = 0; i < cells; ++i) sum += step *= ratio;
    return sum;
  };
  double low = 0.1, high = 100.0;
  for (int i = 0; i < 100; ++i) (length(0.5 * (low + high)) < total ? low : high) = 0.5 * (low + high);
  std::vector<double> x{0.0};
  double step = cell;
  for (int i = 0; i < cells; ++i) x.push_back(x.back() + (step *= low));
  return x;
}

inline palpate::Mesh<palpate::Tet4> make_mesh(const Block& block) {
  std::vector<double> x, z;
  const std::vector<double> beside = growing(half_width - 0.5 * patch, block.beside);
  for (std::size_t i = beside.size(); i-- > 1;) x.push_back(-0.5 * patch - beside[i]);
  for (int i = 0; i <= 16; ++i) x.push_back(-0.5 * patch + i * cell);
  for (std::size_t i = 1; i < beside.size(); ++i) x.push_back(0.5 * patch + beside[i]);
  const std::vector<double> below = growing(height - cell, block.below);
  for (std::size_t i = below.size(); i-- > 0;) z.push_back(height - cell - below[i]);
  z.push_back(height);
  return palpate::box_tet4(x, x, z, palpate::BoxSplit::six);
}

/// Held at the bottom, touchable in the middle of the patch.
inline palpate::Scene make_scene(const palpate::Mesh<palpate::Tet4>& mesh, const Block& block) {
  std::vector<palpate::NodeId> nodes;
  for (palpate::NodeId node : mesh.find_group("z1")->nodes)
    if (mesh.position(node).head<2>().cwiseAbs().maxCoeff() < (0.5 * block.touched + 0.1) * cell) nodes.push_back(node);
  palpate::Scene scene;
  scene.fix("z0").touch(nodes);
  return scene;
}

}  // namespace latency
