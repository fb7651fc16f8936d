// A solver policy for tissue at large strain that is cut while it is touched: Cuttable<Implicit<QuasiNewton<>>>.
#pragma once

#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving_tissue.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

template <class S>
inline constexpr bool has_cuts<Implicit<QuasiNewton<S>>> = true;

}  // namespace detail

/// Moving tissue at large strain that can be cut; see CuttableMovingTissue. Base of HapticFEModel on
/// Cuttable<Implicit<QuasiNewton<S>>>.
template <class E, class M, class S>
class CuttableMotionTissue : public CuttableMovingTissue<E> {
  static_assert(HyperelasticMaterial<M>,
                "palpate: moving tissue that is cut needs a hyperelastic material without memory, for example "
                "NeoHookean");

 public:
  using Parameters = QuasiNewtonParameters;

 protected:
  /// Throws as MotionTissue; unsupported for `large_strain_within` and `renew_factor`.
  template <MeshOf<E> Given>
  CuttableMotionTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                       const SetupOptions& options, const Parameters& parameters)
      : CuttableMovingTissue<E>(options) {
    if (parameters.large_strain_within < infinity || parameters.renew_factor)
      raise(SetupErrorKind::unsupported, "large_strain_within or renew_factor for tissue that is cut",
            "Leave both at their defaults");
    auto admitted = this->template admit_materials<E>(mesh, scene, materials, options, parameters);
    const ScopedIdTranslation translation(this->original_ids());
    this->template set_up_cuts<M, S>(std::move(admitted.body), detail::boundary_of<E>(this->elastic_body()),
                                     admitted.touchable, parameters);
  }
};

template <class S>
struct SolverTraits<Cuttable<Implicit<QuasiNewton<S>>>> {
  template <class E, class M>
  using Tissue = CuttableMotionTissue<E, M, S>;
};

}}  // namespace palpate
