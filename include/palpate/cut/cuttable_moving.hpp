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

/// Moving tissue at large strain that can be cut; see CuttableMovingTissue.
template <class E, class M, class S>
class HapticFEModel<E, M, Cuttable<Implicit<QuasiNewton<S>>>> : public CuttableMovingTissue<E> {
  static_assert(HyperelasticMaterial<M>,
                "palpate: moving tissue that is cut needs a hyperelastic material without memory, for example "
                "NeoHookean");

 public:
  using ElementType = E;
  using MaterialType = M;
  using Parameters = QuasiNewtonParameters;

  /// One material for the whole body. Throws as moving models (model/moving/moving_model.hpp); unsupported for
  /// `large_strain_within` and `renew_factor`.
  template <MeshOf<E> Given>
  HapticFEModel(const Given& mesh, const Scene& scene, const M& material, const SetupOptions& options = {},
                const Parameters& parameters = {})
      : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options, parameters) {}
  /// One material per region.
  template <MeshOf<E> Given>
  HapticFEModel(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {}, const Parameters& parameters = {})
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

  /// The admitted mesh before any cut, in the frame of `origin()`.
  const Mesh<E>& mesh() const noexcept { return body().mesh; }
  const Body<E>& body() const noexcept { return detail::element_body<E>(this->elastic_body()).body(); }
  /// The boundary faces of that mesh, which belong to one element only.
  const std::vector<BoundaryFace>& boundary() const noexcept {
    return detail::element_body<E>(this->elastic_body()).boundary();
  }
};

}}  // namespace palpate
