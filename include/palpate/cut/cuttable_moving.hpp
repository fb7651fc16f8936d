// A solver policy for tissue at large strain that is cut while it is touched: Cuttable<Implicit<QuasiNewton<>>>.
#pragma once

#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving_tissue.hpp>
#include <palpate/model/detail/admitted_mesh.hpp>
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
    detail::require_step(parameters.step);
    if (parameters.large_strain_within < infinity || parameters.renew_factor)
      raise(SetupErrorKind::unsupported, "large_strain_within or renew_factor for tissue that is cut",
            "Leave both at their defaults");
    detail::AdmittedMesh<E> admitted =
        detail::admit_mesh<E>(mesh, scene, options.admission, this->limits(), this->setup_report());
    const ScopedIdTranslation translation(admitted.ids);
    HyperelasticBody<E, M> body = make_hyperelastic_body(std::move(admitted.mesh), materials);
    auto rest = std::make_unique<detail::ElementBody<E>>(body.rest, admitted.origin);
    rest->report_locking(this->setup_report());
    const std::vector<BoundaryFace> boundary = rest->boundary();
    const detail::Touchable touchable =
        this->admit(scene, {std::move(rest), std::move(admitted.node_map), std::move(admitted.ids), admitted.origin});
    const ScopedIdTranslation own(this->original_ids());  // those of `admitted` are moved from
    if (parameters.settle || !parameters.inertia)
      this->elastic_body().require_constrained(this->elastic_body().conditions(this->scene()));
    this->template set_up_cuts<M, S>(std::move(body), boundary, touchable, parameters);
  }
};

template <class S>
struct SolverTraits<Cuttable<Implicit<QuasiNewton<S>>>> {
  template <class E, class M>
  using Tissue = CuttableMotionTissue<E, M, S>;
};

}}  // namespace palpate
