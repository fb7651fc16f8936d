// Words and parameters of the solvers of moving tissue.
#pragma once

#include "tissue_of.hpp"

#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

namespace cross {

template <class E, class M, class Method>
struct Used<palpate::HapticFEModel<E, M, palpate::Implicit<Method>>> {
  using Type = palpate::MovingTissue;
};
template <class E, class M, class Scheme>
struct Used<palpate::HapticFEModel<E, M, palpate::Explicit<Scheme>>> {
  using Type = palpate::MovingTissue;
};

/// Of a solver with no parameter but the step.
template <class Model, class Construct>
std::unique_ptr<Model> make_stepping(const Scene& scene, const Construct& construct) {
  typename Model::Parameters parameters;
  parameters.step = scene.step;
  return construct(parameters);
}

template <>
struct SolverOf<palpate::Implicit<palpate::Newton>> {
  static constexpr const char* word = "newton";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene& scene, const Body&, const Construct& construct) {
    return make_stepping<Model>(scene, construct);
  }
};
template <>
struct SolverOf<palpate::Implicit<palpate::MatrixFreeCG<palpate::BlockJacobi>>> {
  static constexpr const char* word = "corotated_cg";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene& scene, const Body&, const Construct& construct) {
    return make_stepping<Model>(scene, construct);
  }
};

template <class S>
struct SolverOf<palpate::Implicit<palpate::QuasiNewton<S>>> {
  static constexpr const char* word = std::is_same_v<S, float> ? "quasi_newton_float" : "quasi_newton";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene& scene, const Body&, const Construct& construct) {
    return construct({.step = scene.step, .inertia = scene.inertia});
  }
};

/// A step that needs too many stable substeps is shortened to the longest that is allowed, but not below a millisecond.
template <class Scheme>
struct SolverOf<palpate::Explicit<Scheme>> {
  static constexpr const char* word =
      std::is_same_v<Scheme, palpate::CentralDifference> ? "central_difference" : "semi_implicit_euler";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene& scene, const Body&, const Construct& construct) {
    palpate::ExplicitParameters parameters{.step = scene.step};
    try {
      return construct(parameters);
    } catch (const palpate::SetupError& error) {
      const palpate::SetupProblem& p = error.problem();
      parameters.step *= 0.9 * p.threshold / p.value;
      const bool too_many = p.kind == palpate::SetupErrorKind::bad_argument &&
                            p.threshold == parameters.maximum_substeps && p.value > p.threshold;
      if (!too_many || !(parameters.step >= 1e-3)) throw;
    }
    return construct(parameters);
  }
};

}  // namespace cross
