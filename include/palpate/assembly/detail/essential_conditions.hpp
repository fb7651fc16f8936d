// Prescribed displacements: free and prescribed dofs (thesis 3.4.3, BCEssensiell).
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

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

  /// Copies the entries of the free dofs from a full vector. No allocation when `free_part` has its size.
  void gather(const VectorX& full, VectorX& free_part) const noexcept;
  /// Full vector with `free_part` on free dofs and `values` on prescribed dofs.
  void place(const VectorX& free_part, const VectorX& values, VectorX& full) const noexcept;
  /// Full vector with `free_part` on free dofs and zeros on prescribed dofs.
  void scatter(const VectorX& free_part, VectorX& full) const noexcept;
};

/// Resolves the prescribed conditions of a scene. Throws unknown_group, empty_group, or conflicting_conditions when
/// one dof has two different values.
EssentialConditions resolve_essential(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                      const Scene& scene);
template <Element E>
EssentialConditions resolve_essential(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary,
                                      const Scene& scene) {
  return resolve_essential(mesh_ref(mesh), boundary, scene);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/essential_conditions.ipp>
#endif
