// The composition: element, material and solver make a tissue that can be touched.
#pragma once

#include <palpate/assembly/region_materials.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/model/linear_tissue.hpp>
#include <palpate/model/policies.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

template <Element E>
struct Mesh;
template <Element E>
struct Body;
struct BoundaryFace;

/// Linear static tissue. `E` is the element, `M` the material, `Solver` a policy of model/policies.hpp; assembly,
/// quadrature and condensation come with them. The model is prepared once and copies what it needs from mesh and scene.
/// Afterwards it changes through named calls only (loads, prescribed values, gravity, pose, reset), none of which
/// refactorises; none may run while a tick does. Satisfies TissueModel. What does not depend on the types is in its
/// base, LinearTissue.
///
/// Frames: `set_pose` places the frame of the mesh as given in the world of the tools. Forces and displacements have the
/// axes of that mesh. Positions of `mesh()` and of the contact surface have these axes, too, and are relative to
/// `origin()`; `to_world()` maps them to the world.
template <Element E, LinearMaterial M, SolverPolicy Solver = Condensed<SelectiveInverse>>
class HapticFEModel : public LinearTissue<typename SolverTraits<Solver>::Scalar> {
  using Tissue = LinearTissue<typename SolverTraits<Solver>::Scalar>;

 public:
  static_assert(has_triangulated_faces<E>(),
                "palpate: tools touch triangles; give the element's Face a list `triangles` of its nodes, like Tri6");
  using ElementType = E;
  using Traits = SolverTraits<Solver>;

  /// One material everywhere. Throws SetupError; see docs/errors.md for the kinds.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const M& material, const SetupOptions& options = {});

  /// One material per region.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {});

  /// The admitted mesh, in the frame of `origin()`.
  const Mesh<E>& mesh() const noexcept;
  /// The mesh with its materials evaluated (assembly/body.hpp).
  const Body<E>& body() const noexcept;
  /// The faces of the mesh that belong to one element only.
  const std::vector<BoundaryFace>& boundary() const noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY || defined(PALPATE_OWN_TYPES)
#include <palpate/model/haptic_fe_model.tpp>
#endif
