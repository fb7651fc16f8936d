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
template <class E, class M, class Solver>
class StaticTissue;

namespace detail {

/// Readable compile-time checks of element and material.
template <class E, class M>
struct ModelArguments {
  static_assert(Element<E>,
                "palpate: the first argument of HapticFEModel is an element, for example Smoothed<Tet4>; "
                "for a user-defined one see the concept Element");
  static_assert(has_triangulated_faces<E>(),
                "palpate: tools touch triangles; give the element's Face a list `triangles` of its nodes, like Tri6");
  static_assert(Material<M>, "palpate: the second argument of HapticFEModel is a material, for example LinearElastic");
};

/// The base of a model: StaticTissue, or what the traits of the solver name. For motions see
/// model/moving/moving_model.hpp.
template <class E, class M, class Solver>
struct TissueOf : ModelArguments<E, M> {
  using Type = StaticTissue<E, M, Solver>;
};
/// Whether the traits of a solver have a member named Tissue, of whatever kind: the name is then ambiguous here, so
/// that one that does not fit is an error and not ignored.
struct OtherTissue {
  static int Tissue;
};
template <class Solver>
struct TissueLookup : SolverTraits<Solver>, OtherTissue {};
template <class Solver>
concept NamesTissue = requires {
  sizeof(SolverTraits<Solver>);
}
&&!requires {
  TissueLookup<Solver>::Tissue;
};
template <class E, class M, NamesTissue Solver>
struct TissueOf<E, M, Solver> : ModelArguments<E, M> {
  using Type = typename SolverTraits<Solver>::template Tissue<E, M>;
};

/// Readable compile-time checks of a static solver, and the base of its tissue.
template <class M, class Solver>
struct StaticBase {
  static_assert(SolverPolicy<Solver>,
                "palpate: the third argument of HapticFEModel is a solver: Condensed<SelectiveInverse>, SparseCholesky "
                "...; Implicit and Explicit come with palpate/soft.hpp, Cuttable with palpate/cut.hpp; for a "
                "user-defined one specialise SolverTraits");
  static_assert(!Material<M> || !SolverPolicy<Solver> || LinearMaterial<M>,
                "palpate: this solver is for statics at small strain, which takes a LinearMaterial; for large strain "
                "or viscoelasticity choose Implicit<Newton>");
  using Type = LinearTissue<typename SolverTraits<Solver>::Scalar>;
};

// Definitions: model/detail/element_body.hpp.
template <Element E>
const Mesh<E>& mesh_of(const ElasticBody& body) noexcept;
template <Element E>
const Body<E>& body_of(const ElasticBody& body) noexcept;
template <Element E>
const std::vector<BoundaryFace>& boundary_of(const ElasticBody& body) noexcept;

}  // namespace detail

/// Parameters of a model whose solver has none.
struct NoParameters {};

/// Linear static tissue of element `E`, material `M` and a solver with SolverTraits::make. Base of HapticFEModel on
/// such a solver.
template <class E, class M, class Solver>
class StaticTissue : public detail::StaticBase<M, Solver>::Type {
 public:
  using Parameters = NoParameters;

 protected:
  template <MeshOf<E> Given>
  StaticTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials, const SetupOptions& options,
               const Parameters& = {});
};

/// Tissue of element `E`, material `M` and solver `Solver`. These determine assembly, quadrature, condensation and
/// motion, and by that the base with most functions: LinearTissue, MovingTissue, CuttableTissue or
/// CuttableMovingTissue. The model is prepared once and copies the data it needs from mesh and scene. Afterwards only
/// named calls change it (loads, prescribed values, gravity, pose, reset, cuts, steps). Satisfies TissueModel. Frames:
/// see ModelBase. If SolverTraits<Solver> has a class template `Tissue<E, M>`, the model derives from it; it needs a
/// type Parameters and a constructor with the arguments of the second constructor below.
template <class E, class M, class Solver = Condensed<SelectiveInverse>>
class HapticFEModel : public detail::TissueOf<E, M, Solver>::Type {
  using Tissue = typename detail::TissueOf<E, M, Solver>::Type;

 public:
  using ElementType = E;
  using MaterialType = M;
  /// Of the solver: its step, tolerances, curves ...
  using Parameters = typename Tissue::Parameters;

  /// One material everywhere. Throws SetupError; see docs/errors.md for the kinds.
  template <MeshOf<E> Given>
  HapticFEModel(const Given& mesh, const Scene& scene, const M& material, const SetupOptions& options = {},
                const Parameters& parameters = {})
      : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options, parameters) {}
  /// One material per region.
  template <MeshOf<E> Given>
  HapticFEModel(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {}, const Parameters& parameters = {})
      : Tissue(mesh, scene, materials, options, parameters) {}

  /// The admitted mesh before any cut, in the frame of `origin()`.
  const Mesh<E>& mesh() const noexcept { return detail::mesh_of<E>(this->elastic_body()); }
  /// The mesh with its materials, linearised at small strain (assembly/body.hpp).
  const Body<E>& body() const noexcept { return detail::body_of<E>(this->elastic_body()); }
  /// The boundary faces: faces of the mesh that belong to one element only.
  const std::vector<BoundaryFace>& boundary() const noexcept { return detail::boundary_of<E>(this->elastic_body()); }
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY || defined(PALPATE_OWN_TYPES)
#include <palpate/model/haptic_fe_model.tpp>
#endif
