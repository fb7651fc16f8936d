// Word and parameters of the solvers of moving tissue that is cut.
#pragma once

#include "tissue_of.hpp"

#include <palpate/cut/cuttable_moving.hpp>

namespace cross {

template <class S>
struct SolverOf<palpate::Cuttable<palpate::Implicit<palpate::QuasiNewton<S>>>> {
  static constexpr const char* word = std::is_same_v<S, float> ? "cut_quasi_newton_float" : "cut_quasi_newton";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene& scene, const Body&, const Construct& construct) {
    return construct({.step = scene.step, .inertia = scene.inertia});
  }
};

template <class E, class M, class S>
struct Used<palpate::HapticFEModel<E, M, palpate::Cuttable<palpate::Implicit<palpate::QuasiNewton<S>>>>> {
  using Type = palpate::CuttableMovingTissue<E>;
};

}  // namespace cross
