// A co-rotated tissue that steps at the rate of the device.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/basic_soft_tissue.hpp>
#include <palpate/model/corotated_motion.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/equilibrium.hpp>
#include <palpate/model/tissue_motion.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

template <class Base, class S, class Preconditioner>
struct TissueMotion<CorotatedMotion<Base, S, Preconditioner>> {
  using Parameters = CorotatedMotionOptions;
  using Body = HyperelasticBody<Tet4, Corotational<Base>>;
  using Source = std::pair<Body, Scene>;
  static constexpr double usual_step = 1e-3;
  static Parameters usual() { return {.solve = {.maximum_iterations = 40, .tolerance = 3e-3}}; }

  template <class Given>
  static Source source(Given body, const Scene& scene, const SetupLimits&) {
    static_assert(std::same_as<Given, Body>,
                  "palpate: a co-rotated tissue is made of Tet4 and Corotational<...>; for others take SoftTissue");
    return {std::move(body), scene};
  }
  static VectorX settle(Source& source, const SetupLimits& limits) {
    Equilibrium statics(make_held_body(source.first, source.second, limits), limits);
    return detail::settled(statics);
  }
  static bool close(const CorotatedStep& r) noexcept {
    return r.taken && r.calm && r.solve.error <= CorotatedMotion<Base, S, Preconditioner>::tolerable_error;
  }
};

/// A tissue of Tet4 and Corotational<LinearElastic> that steps without a factor, in single precision: 1 kHz up to some
/// ten thousand elements on a core; see CorotatedMotion.
using CorotatedTissue = BasicSoftTissue<CorotatedMotion<>>;

}}  // namespace palpate
