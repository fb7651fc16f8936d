// Definitions of essential_conditions.hpp.
#pragma once

#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/selection.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void EssentialConditions::gather(const VectorX& full, VectorX& free_part) const noexcept {
  for (Index k = 0; k < free_count(); ++k) free_part[k] = full[free_dofs[static_cast<std::size_t>(k)]];
}

PALPATE_INLINE void EssentialConditions::place(const VectorX& free_part, const VectorX& values,
                                               VectorX& full) const noexcept {
  full = values;
  for (Index k = 0; k < free_count(); ++k) full[free_dofs[static_cast<std::size_t>(k)]] = free_part[k];
}

PALPATE_INLINE void EssentialConditions::scatter(const VectorX& free_part, VectorX& full) const noexcept {
  full.setZero();
  for (Index k = 0; k < free_count(); ++k) full[free_dofs[static_cast<std::size_t>(k)]] = free_part[k];
}

PALPATE_INLINE EssentialConditions resolve_essential(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                                     const Scene& scene) {
  EssentialConditions c;
  c.constrained.assign(static_cast<std::size_t>(mesh.node_count), 0);
  c.prescribed = VectorX::Zero(3 * mesh.node_count);
  for (const auto& condition : scene.prescribed())
    for (NodeId node : resolve_nodes(mesh, boundary, condition.where))
      for (int i = 0; i < 3; ++i) {
        const auto& value = condition.values[static_cast<std::size_t>(i)];
        if (!value) continue;
        auto& bits = c.constrained[static_cast<std::size_t>(node)];
        const Index dof = 3 * Index{node} + i;
        if ((bits & (1u << i)) != 0 && c.prescribed[dof] != *value)
          raise_at(SetupIds::nodes, node, SetupErrorKind::conflicting_conditions,
                   std::string("component ") + "xyz"[i] + " of a node is prescribed as " + number(c.prescribed[dof]) +
                       " and as " + number(*value),
                   "Prescribe one value per component");
        bits = static_cast<std::uint8_t>(bits | (1u << i));
        c.prescribed[dof] = *value;
      }
  c.free_index.assign(static_cast<std::size_t>(3 * mesh.node_count), -1);
  for (Index dof = 0; dof < 3 * mesh.node_count; ++dof)
    if ((c.constrained[static_cast<std::size_t>(dof / 3)] & (1u << (dof % 3))) == 0) {
      c.free_index[static_cast<std::size_t>(dof)] = static_cast<Index>(c.free_dofs.size());
      c.free_dofs.push_back(dof);
    }
  return c;
}

}}  // namespace palpate
