// HapticFEModel for moving tissue: element, material, and a solver that integrates in time.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/model/detail/admitted_mesh.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/moving_tissue.hpp>

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Dynamics with implicit steps: Implicit<Newton>, Implicit<MatrixFreeCG<...>>
/// (model/moving/implicit.hpp), Implicit<QuasiNewton<>> (model/moving/quasi_newton.hpp).
template <class StepSolver>
struct Implicit {};

/// A solver policy for dynamics. SolverTraits<P> has
///   Parameters                                    an aggregate with `step` [s]; with `settle`, a body that can still
///                                                 move as a whole is refused when that is true
///   make_motion(body, scene, parameters, limits)  a PreparedMotion; `body` is a HyperelasticBody at large strain, at
///   small
///                                                 strain a Body or ViscousBody
/// Shipped: Implicit<...> (model/moving/implicit.hpp), Explicit<...> (model/moving/explicit.hpp).
template <class P>
concept MotionPolicy = requires(const typename SolverTraits<P>::Parameters& parameters) {
  { parameters.step } -> std::convertible_to<double>;
};

namespace detail {

/// The material-independent part of a material body: mesh, elasticity at rest, densities.
template <class MaterialBody>
const auto& rest_body(const MaterialBody& body) noexcept {
  if constexpr (requires { body.rest.mesh; })
    return body.rest;
  else if constexpr (requires { body.fast.mesh; })
    return body.fast;
  else
    return body;
}

/// Throws bad_argument.
inline void require_step(double step) {
  if (!(step > 0.0 && step < infinity))
    raise(SetupErrorKind::bad_argument, "a step of " + number(step) + " s", "Give a positive time in seconds");
}

}  // namespace detail

template <Element E, class Given, class M, class Parameters>
auto MovingTissue::admit_materials(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                                   const SetupOptions& options, const Parameters& parameters) {
  detail::require_step(parameters.step);
  detail::AdmittedMesh<E> admitted = detail::admit_mesh<E>(mesh, scene, options.admission, limits(), setup_report());
  const ScopedIdTranslation translation(admitted.ids);
  auto body = detail::make_any_body(std::move(admitted.mesh), materials);
  auto rest = std::make_unique<detail::ElementBody<E>>(detail::rest_body(body), admitted.origin);
  rest->report_locking(setup_report());
  detail::Touchable touchable =
      admit(scene, {std::move(rest), std::move(admitted.node_map), std::move(admitted.ids), admitted.origin});
  const ScopedIdTranslation own(original_ids());  // those of `admitted` are moved from
  bool must_hold = false;                         // without supports there is no equilibrium
  if constexpr (requires { parameters.settle; }) must_hold = parameters.settle;
  if constexpr (requires { parameters.inertia; }) must_hold = must_hold || !parameters.inertia;
  if (must_hold) elastic_body().require_constrained(elastic_body().conditions(this->scene()));
  return AdmittedMaterials<decltype(body)>{std::move(body), std::move(touchable)};
}

/// Moving tissue of element `E`, material `M` and a solver with SolverTraits::make_motion; see MovingTissue. Base of
/// HapticFEModel on such a solver. Initial strains are supported for linear materials only. Set-up solves once per
/// touchable dof.
template <class E, class M, class Solver>
class MotionTissue : public MovingTissue {
 public:
  using Parameters = typename SolverTraits<Solver>::Parameters;

 protected:
  /// Throws as admit_materials, the errors of assembly and the motion, not_converged when no initial equilibrium is
  /// found, unsupported for a cache file.
  template <MeshOf<E> Given>
  MotionTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials, const SetupOptions& options,
               const Parameters& parameters)
      : MovingTissue(options) {
    auto admitted = admit_materials<E>(mesh, scene, materials, options, parameters);
    if constexpr (
        requires { typename M::LargeStrainHistory; } || requires { admitted.body.fast.mesh; })
      admitted.touchable.elements.clear();  // the dent of a small tool relaxes, its law does not
    const ScopedIdTranslation translation(original_ids());
    PreparedMotion prepared =
        SolverTraits<Solver>::make_motion(std::move(admitted.body), this->scene(), parameters, limits());
    set_up(admitted.touchable, std::move(prepared), parameters.step,
           detail::block_pattern(detail::mesh_of<E>(elastic_body())));
  }
};

namespace detail {

template <class E, class M, MotionPolicy Solver>
struct TissueOf<E, M, Solver> : ModelArguments<E, M> {
  using Type = MotionTissue<E, M, Solver>;
};

}  // namespace detail

}}  // namespace palpate
