// Example 06: a user-defined element. Checks it with the law suite, then uses it for a beam that deflects under its
// weight.
#include <palpate/own_types.hpp>
#include <palpate/elements.hpp>
#include <palpate/palpate.hpp>
#include <palpate/testing/element_laws.hpp>

#include <cstdio>
#include <map>

#include "hex12.hpp"

using namespace palpate;

namespace {

/// The hexahedra of a mesh with a node in the middle of every edge along their first axis. Groups keep their corner
/// nodes only; select faces by "surface" or by node lists.
Mesh<own::Hex12> with_middles(const Mesh<Hex8>& mesh) {
  constexpr std::array<std::array<std::size_t, 2>, 4> edges{{{0, 1}, {3, 2}, {4, 5}, {7, 6}}};
  Mesh<own::Hex12> fine{mesh.positions, {}, mesh.regions, mesh.region_names, {}};
  std::map<std::pair<NodeId, NodeId>, NodeId> middle;
  for (const auto& corners : mesh.elements) {
    auto& nodes = fine.elements.emplace_back();
    std::ranges::copy(corners, nodes.begin());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const NodeId a = corners[edges[i][0]], b = corners[edges[i][1]];
      const auto [at, made] = middle.try_emplace(std::minmax(a, b), static_cast<NodeId>(fine.positions.size()));
      if (made) fine.positions.push_back(0.5 * (mesh.position(a) + mesh.position(b)));
      nodes[8 + i] = at->second;
    }
  }
  return fine;
}

/// Deflection of the free end of a beam, 0.2 m long and 0.02 m thick, under its weight [m].
template <Element E>
double deflection(const Mesh<E>& mesh, Index& dofs) {
  const HapticFEModel<E, LinearElastic, SparseCholesky> beam(
      mesh, Scene().fix(where::below(Vector3::Zero(), Vector3::UnitX())).gravity({0, 0, -9.81}),
      LinearElastic{.youngs_modulus = 5e6, .poisson_ratio = 0.3, .density = 1060.0});
  dofs = beam.report().free_dofs;
  double lowest = 0.0;
  for (Index i = 2; i < beam.displacement().size(); i += 3) lowest = std::min(lowest, beam.displacement()[i]);
  return -lowest;
}

}  // namespace

int main() {
  const auto violations = testing::element_laws<own::Hex12>();
  std::printf("laws of Hex12: %s\n", violations.empty() ? "satisfied" : testing::describe(violations).c_str());

  const Vector3 size(0.2, 0.02, 0.02);
  Index dofs = 0;
  const double exact = deflection(box_hex20(size, {40, 4, 4}), dofs);
  std::printf("a beam under its weight deflects by %.4f mm (Hex20, %lld dofs)\n", 1e3 * exact,
              static_cast<long long>(dofs));
  std::printf("%10s %8s %15s %8s\n", "element", "dofs", "deflection [mm]", "error");
  const auto row = [&](const char* name, double value) {
    std::printf("%10s %8lld %15.4f %7.1f %%\n", name, static_cast<long long>(dofs), 1e3 * value,
                100.0 * (value / exact - 1.0));
    return value / exact - 1.0;
  };
  row("Hex8", deflection(box_hex8(size, {10, 2, 2}), dofs));
  row("Hex8", deflection(box_hex8(size, {20, 2, 2}), dofs));
  const double error = row("Hex12", deflection(with_middles(box_hex8(size, {10, 2, 2})), dofs));
  return violations.empty() && std::abs(error) < 0.05 ? 0 : 1;
}
