// HapticFEModel: tissue composed of element, material and solver.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/static/linear_tissue.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

template <Element E>
struct Mesh;
template <Element E>
struct Body;
struct BoundaryFace;

namespace detail {

/// Readable compile-time checks of the arguments of the primary template, and its base class.
template <class E, class M, class Solver>
struct StaticModel {
  static_assert(Element<E>,
                "palpate: the first argument of HapticFEModel is an element, for example Smoothed<Tet4>; "
                "for a user-defined one see the concept Element");
  static_assert(Material<M>, "palpate: the second argument of HapticFEModel is a material, for example LinearElastic");
  static_assert(SolverPolicy<Solver>,
                "palpate: the third argument of HapticFEModel is a solver: Condensed<SelectiveInverse>, SparseCholesky "
                "...; Implicit and Explicit come with palpate/soft.hpp, Cuttable with palpate/cut.hpp; for a "
                "user-defined one specialise SolverTraits");
  static_assert(!Material<M> || !SolverPolicy<Solver> || LinearMaterial<M>,
                "palpate: this solver is for statics at small strain, which takes a LinearMaterial; for large strain "
                "or viscoelasticity choose Implicit<Newton<SparseCholesky>>");
  using Base = LinearTissue<typename SolverTraits<Solver>::Scalar>;
};

}  // namespace detail

/// Tissue of element `E`, material `M` and solver `Solver`. The primary template is linear and static; moving, cut and
/// stiffening tissue are specialisations on their solvers, with the same constructor and functions. The arguments
/// determine assembly, quadrature and condensation. The model is prepared once and copies the data it needs from mesh
/// and scene. Afterwards only named calls change it (loads, prescribed values, gravity, pose, reset). None of them
/// refactorises, and none may run during a tick. Satisfies TissueModel. The base LinearTissue contains the parts that
/// do not depend on the types. Frames: see ModelBase.
template <class E, class M, class Solver = Condensed<SelectiveInverse>>
class HapticFEModel : public detail::StaticModel<E, M, Solver>::Base {
  using Tissue = typename detail::StaticModel<E, M, Solver>::Base;

 public:
  static_assert(detail::has_triangulated_faces<E>(),
                "palpate: tools touch triangles; give the element's Face a list `triangles` of its nodes, like Tri6");
  using ElementType = E;
  using MaterialType = M;
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
  /// The boundary faces: faces of the mesh that belong to one element only.
  const std::vector<BoundaryFace>& boundary() const noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY || defined(PALPATE_OWN_TYPES)
#include <palpate/model/haptic_fe_model.tpp>
#endif
