// Tissue at any strain in motion by Newton's method, felt at the rate of the device.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/basic_soft_tissue.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/equilibrium.hpp>
#include <palpate/model/implicit_dynamics.hpp>
#include <palpate/model/tissue_motion.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

template <>
struct TissueMotion<ImplicitDynamics> {
  using Parameters = DynamicsParameters;
  using Source = DeformableBody;
  static constexpr double usual_step = 0.01;
  static Parameters usual() { return {.newton = {.maximum_iterations = 2, .tolerance = 1e-9}}; }

  template <class Body>
  static Source source(Body body, const Scene& scene, const SetupLimits& limits) {
    return make_deformable_body(std::move(body), scene, limits);
  }
  static VectorX settle(Source& body, const SetupLimits& limits) {
    Equilibrium statics(std::move(body), limits);
    VectorX u = detail::settled(statics);
    body = std::move(statics).release();
    return u;
  }
  static bool close(const StepReport& r) noexcept {
    return r.taken && r.calm && (r.newton.converged || r.newton.relative_residual <= 0.05);
  }
};

/// Solved by Newton's method with a factor: any element, law and step; see ImplicitDynamics.
using SoftTissue = BasicSoftTissue<ImplicitDynamics>;
using SoftTissueOptions = TissueOptions<ImplicitDynamics>;

static_assert(TissueModel<SoftTissue>);

}}  // namespace palpate
