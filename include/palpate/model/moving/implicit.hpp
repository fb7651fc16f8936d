// Solver policies for dynamics with implicit time steps: Implicit<Newton>, Implicit<MatrixFreeCG<...>>.
#pragma once

#include <palpate/model/moving/detail/corotated_motion.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/model/moving/moving_model.hpp>
#include <palpate/model/moving/tissue_motion.hpp>
#include <palpate/model/policies.hpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Wraps an ImplicitDynamics. A step whose iterations end early may leave a residual of a twentieth of the force.
class ImplicitMotion final : public TissueMotion {
 public:
  static constexpr double tolerable_residual = 0.05;

  ImplicitMotion(DeformableBody body, const DynamicsParameters& parameters, const SetupLimits& limits)
      : motion_(std::move(body), parameters, limits) {}

  MotionStep step(double h) noexcept override;
  bool correct(const VectorX& more) noexcept override { return motion_.correct(more); }
  bool set_springs(std::span<const ContactSpring> springs) noexcept override {
    motion_.set_springs(springs);
    return true;
  }
  bool prepare_response(double h) noexcept override { return motion_.prepare_response(h); }
  bool respond(const VectorX& forces, VectorX& u) noexcept override { return motion_.respond(forces, u); }
  bool respond_here(const VectorX& forces, VectorX& u) noexcept override {
    return motion_.is_factorised() && motion_.respond(forces, u);
  }
  const VectorX& displacement() const noexcept override { return motion_.displacement(); }
  const VectorX& velocity() const noexcept override { return motion_.velocity(); }
  void rest_at(const VectorX& u) override { motion_.rest_at(u); }
  void set_load(const VectorX& load) override { motion_.set_load(load); }
  void set_prescribed(const VectorX& values) override { motion_.set_prescribed(values); }

 private:
  ImplicitDynamics motion_;
};

inline MotionStep ImplicitMotion::step(double h) noexcept {
  const StepReport done = motion_.step(h);
  MotionStep step{done.taken, {}, done.deformation};
  if (done.deformation.inverted > 0) step.status.set(StatusFlag::inverted);
  if (done.deformation.beyond_range > 0) step.status.set(StatusFlag::material_exceeded);
  const bool accurate = done.newton.converged || done.newton.relative_residual <= tolerable_residual;
  if (!done.taken || !done.energy_bounded || !accurate) step.status.set(StatusFlag::solver_not_converged);
  return step;
}

}  // namespace detail

/// Newton's method on the incremental potential of a step, with a factorisation in every iteration. Supports all
/// elements except smoothed ones, all materials and all step lengths. See ImplicitDynamics.
struct Newton {};

/// Matrix-free conjugate gradients in scalar type S, with bounded work per step. For Tet4 and Corotational. See
/// CorotatedMotion. `Preconditioner` is BlockJacobi or another StepPreconditioner.
template <class Preconditioner, class S = float>
struct MatrixFreeCG {};

/// Parameters of a model on Implicit<Newton>.
struct ImplicitParameters {
  double step = 0.01;  ///< [s]
  bool settle = true;  ///< start in equilibrium under the scene's loads
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s]
  MassKind mass = MassKind::lumped;
  NewtonParameters newton{.maximum_iterations = 2, .tolerance = 1e-9};
};

template <>
struct SolverTraits<Implicit<Newton>> {
  using Parameters = ImplicitParameters;

  template <class Body>
  static PreparedMotion make_motion(Body body, const Scene& scene, const Parameters& p, const SetupLimits& limits) {
    constexpr bool is_linear = requires {
      body.mesh;
    };
    return prepare(make_deformable_body(std::move(body), scene, limits), is_linear, p, limits);
  }

 private:
  static PreparedMotion prepare(DeformableBody body, bool is_linear, const Parameters& parameters,
                                const SetupLimits& limits);
};

/// Parameters of a model on Implicit<MatrixFreeCG<...>>.
struct CorotatedParameters {
  double step = 1e-3;  ///< [s]
  bool settle = true;  ///< start in equilibrium under the scene's loads
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s]
  detail::BoundedSolveParameters solve{.maximum_iterations = 40, .tolerance = 3e-3};
  int precondition_every = 16;  ///< steps between two updates of the preconditioner
  bool check = true;  ///< compare the energy after a step with that before it; costs one more force evaluation
  int maximum_linearisations = 8;  ///< per step, when the check fails
};

namespace detail {

/// TissueMotion on a CorotatedMotion.
template <class S, class Preconditioner>
class CorotatedTissueMotion final : public TissueMotion {
 public:
  using Motion = CorotatedMotion<S, Preconditioner>;
  CorotatedTissueMotion(const HyperelasticBody<Tet4, Corotational>& body, const Scene& scene,
                        const CorotatedMotionOptions& options, const SetupLimits& limits)
      : motion_(body, scene, options, limits) {}

  MotionStep step(double h) noexcept override {
    const CorotatedStep done = motion_.step(h);
    MotionStep step{done.taken, {}, done.deformation};
    if (done.deformation.inverted > 0) step.status.set(StatusFlag::inverted);
    if (done.deformation.beyond_range > 0) step.status.set(StatusFlag::material_exceeded);
    if (!done.taken || !done.energy_bounded || !(done.solve.error <= Motion::tolerable_error))
      step.status.set(StatusFlag::solver_not_converged);
    return step;
  }
  bool correct(const VectorX& more) noexcept override { return motion_.correct(more); }
  bool prepare_response(double h) noexcept override { return motion_.prepare_response(h); }
  bool respond(const VectorX& forces, VectorX& u) noexcept override { return motion_.respond(forces, u); }
  const VectorX& displacement() const noexcept override { return motion_.displacement(); }
  const VectorX& velocity() const noexcept override { return motion_.velocity(); }
  void rest_at(const VectorX& u) override { motion_.rest_at(u); }
  void set_load(const VectorX& load) override { motion_.set_load(load); }
  void set_prescribed(const VectorX& values) override { motion_.set_prescribed(values); }

 private:
  Motion motion_;
};

}  // namespace detail

template <class Preconditioner, class S>
struct SolverTraits<Implicit<MatrixFreeCG<Preconditioner, S>>> {
  using Parameters = CorotatedParameters;

  template <class Body>
  static PreparedMotion make_motion(const Body&, const Scene&, const Parameters&, const SetupLimits&) {
    static_assert(sizeof(Body) == 0,
                  "palpate: MatrixFreeCG moves Tet4 with Corotational; for others take "
                  "Implicit<Newton>");
    return {};
  }
  static PreparedMotion make_motion(const HyperelasticBody<Tet4, Corotational>& body, const Scene& scene,
                                    const Parameters& p, const SetupLimits& limits) {
    PreparedMotion made;
    made.large_strain = true;
    made.start = VectorX::Zero(3 * body.rest.mesh.node_count());
    if (p.settle) {
      Equilibrium statics(make_constrained_body(body, scene, limits), limits);
      made.start = detail::settled(statics);
    }
    const detail::CorotatedMotionOptions options{
        p.scheme, p.mass_damping,          p.stiffness_damping, p.solve, p.precondition_every,
        p.check,  p.maximum_linearisations};
    made.motion = std::make_unique<detail::CorotatedTissueMotion<S, Preconditioner>>(body, scene, options, limits);
    return made;
  }
};

inline PreparedMotion SolverTraits<Implicit<Newton>>::prepare(DeformableBody body, bool is_linear, const Parameters& p,
                                                              const SetupLimits& limits) {
  PreparedMotion made;
  made.accepts_initial_strains = is_linear;
  made.large_strain = !is_linear;
  made.start = VectorX::Zero(body.load.size());
  if (p.settle) {
    Equilibrium statics(std::move(body), limits);
    made.start = detail::settled(statics);
    body = std::move(statics).take();
  }
  const DynamicsParameters parameters{p.scheme, p.mass_damping, p.stiffness_damping, p.mass, p.newton};
  made.motion = std::make_unique<detail::ImplicitMotion>(std::move(body), parameters, limits);
  return made;
}

}}  // namespace palpate
