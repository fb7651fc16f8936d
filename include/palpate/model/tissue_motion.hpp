// What a moving tissue asks of the motion below it.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/admission_policy.hpp>
#include <palpate/model/equilibrium.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What a moving tissue asks of a motion; specialise for motions of your own.
///   Parameters, usual_step [s], usual()    what the motion is made with, Motion(source, parameters, limits)
///   source(body, scene, limits)            what it is made from
///   settle(source, limits)                 its displacement in equilibrium; throws not_converged
///   close(report)                          whether a step ended near its answer
/// The motion itself: step, correct, respond, prepare_response, set_state, set_load, displacement, body, as
/// ImplicitDynamics has them.
template <class Motion>
struct TissueMotion;

namespace detail {

/// Displacement of the equilibrium, or not_converged.
VectorX settled(Equilibrium& statics);

}  // namespace detail

template <class Motion>
struct TissueOptions {
  double step = TissueMotion<Motion>::usual_step;  ///< of the motion [s]
  typename TissueMotion<Motion>::Parameters motion = TissueMotion<Motion>::usual();
  bool settle = true;  ///< start in equilibrium under the scene's loads
  AdmissionPolicy admission{};
  SetupLimits limits{};
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/tissue_motion.ipp>
#endif
