// A solver policy for linear tissue that is cut while it is touched: Cuttable<Condensed<SelectiveInverse>>.
#pragma once

#include <palpate/cut/cuttable_tissue.hpp>
#include <palpate/cut/detail/cut_visual_surface.hpp>
#include <palpate/model/detail/admit_body.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/policies.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Whether tissue of a solver can be cut.
template <class Solver>
inline constexpr bool has_cuts = std::same_as<Solver, Condensed<SelectiveInverse>>;

/// The solver `Inner` for tissue that is cut: Condensed<SelectiveInverse>, whose compliance follows cuts exactly, or
/// Implicit<QuasiNewton<>> (cut/cuttable_moving.hpp).
template <class Inner>
struct Cuttable {
  static_assert(has_cuts<Inner>,
                "palpate: tissue that is cut is Cuttable<Condensed<SelectiveInverse>>, or with "
                "palpate/cut/cuttable_moving.hpp Cuttable<Implicit<QuasiNewton<>>>");
};

/// Linear static tissue that can be cut; see CuttableTissue.
template <class E, class M, class Inner>
class HapticFEModel<E, M, Cuttable<Inner>> : public CuttableTissue<E> {
  static_assert(sizeof(Cuttable<Inner>) > 0);  // instantiates Cuttable first, so that its error about Inner comes first
  static_assert(!HasSmoothedStrain<E>,
                "palpate: a cut changes the averages of smoothed elements far from it: choose Tet4 or Tet10");
  static_assert(LinearMaterial<M>, "palpate: tissue that is cut needs a LinearMaterial, for example LinearElastic");

 public:
  using ElementType = E;
  using MaterialType = M;
  using Parameters = CutParameters;

  /// One material for the whole body. Throws as admission, assembly and factorisation; unconstrained when a part is not
  /// constrained, unsupported for a cache file.
  template <MeshOf<E> Given>
  HapticFEModel(const Given& mesh, const Scene& scene, const M& material, const SetupOptions& options = {},
                const Parameters& parameters = {})
      : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options, parameters) {}
  /// One material per region.
  template <MeshOf<E> Given>
  HapticFEModel(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {}, const Parameters& parameters = {})
      : CuttableTissue<E>(options) {
    this->set_up(scene,
                 detail::admit_body<E>(mesh, scene, materials, options.admission, this->limits(), this->setup_report()),
                 parameters);
  }
};

}}  // namespace palpate
