// Prescribed displacements: free and prescribed dofs (thesis 3.4.3, BCEssensiell).
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Numbering of the free dofs of a mesh and values of the prescribed dofs. Dof 3 i + c is component c of node i.
struct EssentialConditions {
  std::vector<std::uint8_t> constrained;  ///< per node, bit c set when component c is prescribed
  VectorX prescribed;                     ///< 3 values per node [m]; zero on free dofs
  std::vector<Index> free_dofs;           ///< dof of every free index, ascending
  std::vector<Index> free_index;          ///< free index of every dof, -1 when prescribed

  bool is_constrained(Index dof) const noexcept { return free_index[static_cast<std::size_t>(dof)] < 0; }
  Index dof_count() const noexcept { return static_cast<Index>(free_index.size()); }
  Index free_count() const noexcept { return static_cast<Index>(free_dofs.size()); }

  /// Throws unsupported unless the same components are prescribed; values may differ.
  void require_components(const EssentialConditions& other) const {
    if (constrained != other.constrained)
      raise(SetupErrorKind::unsupported,
            "the new scene prescribes other components than the one the model was made for",
            "Values may change, the set of prescribed components may not: make a new model");
  }

  /// Whether a prescribed dof of `full` differs from its value in `values`.
  bool supports_move(const VectorX& full, const VectorX& values) const noexcept {
    for (Index dof = 0; dof < dof_count(); ++dof)
      if (is_constrained(dof) && full[dof] != values[dof]) return true;
    return false;
  }

  /// Copies the entries of the free dofs from a full vector. No allocation when `free_part` has its size.
  void gather(const VectorX& full, VectorX& free_part) const noexcept {
    for (Index k = 0; k < free_count(); ++k) free_part[k] = full[free_dofs[static_cast<std::size_t>(k)]];
  }
  /// Full vector with `free_part` on free dofs and `values` on prescribed dofs.
  void scatter(const VectorX& free_part, const VectorX& values, VectorX& full) const noexcept {
    full = values;
    for (Index k = 0; k < free_count(); ++k) full[free_dofs[static_cast<std::size_t>(k)]] = free_part[k];
  }
  /// Full vector with `free_part` on free dofs and zeros on prescribed dofs.
  void scatter(const VectorX& free_part, VectorX& full) const noexcept {
    full.setZero();
    for (Index k = 0; k < free_count(); ++k) full[free_dofs[static_cast<std::size_t>(k)]] = free_part[k];
  }
};

/// Resolves the prescribed conditions of a scene. Throws unknown_group, empty_group, or conflicting_conditions when
/// one dof has two different values.
inline EssentialConditions resolve_essential(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
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
          detail::raise_at(SetupIds::nodes, node, SetupErrorKind::conflicting_conditions,
                           std::string("component ") + "xyz"[i] + " of a node is prescribed as " +
                               number(c.prescribed[dof]) + " and as " + number(*value),
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

template <Element E>
EssentialConditions resolve_essential(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary,
                                      const Scene& scene) {
  return resolve_essential(mesh_ref(mesh), boundary, scene);
}

}}  // namespace palpate
