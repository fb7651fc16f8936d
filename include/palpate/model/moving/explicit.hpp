// A solver policy for dynamics with explicit time steps: Explicit<CentralDifference>.
#pragma once

#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/assembly/element_frequency.hpp>
#include <palpate/assembly/viscous_forces.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/moving_model.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Dynamics with explicit steps and a lumped mass, without a matrix or a factorisation. `Scheme` is CentralDifference
/// or SemiImplicitEuler.
template <ExplicitScheme Scheme>
struct Explicit {};

/// Parameters of a model on Explicit<...>.
struct ExplicitParameters {
  double step = 1e-3;          ///< [s] between two published surfaces; divided into equal stable substeps
  bool settle = true;          ///< start in equilibrium under the scene's loads
  double mass_damping = 0.0;   ///< alpha of the mass-proportional damping [1/s]
  double margin = 0.07;        ///< relative safety margin below the estimated stability limit
  int maximum_substeps = 200;  ///< per step; more are refused: at set-up bad_argument, later step_refused
};

namespace detail {

/// TissueMotion on an ExplicitMotion. A step consists of equal stable substeps; a correction repeats them with the new
/// forces. The response to a force (`respond`) is found by taking the step with that force.
template <ForceOperator Force, ExplicitScheme Scheme>
class ExplicitTissueMotion final : public TissueMotion {
 public:
  /// Throws the errors of ExplicitMotion, and bad_argument when a step needs more than `maximum_substeps`.
  ExplicitTissueMotion(Force force, const VectorX& lumped, const EssentialConditions& conditions,
                       double frequency_bound, const ExplicitParameters& parameters)
      : motion_(std::move(force), lumped, conditions.free_dofs, frequency_bound,
                {.damping = parameters.mass_damping, .margin = parameters.margin}),
        prescribed_(conditions.prescribed),
        maximum_substeps_(parameters.maximum_substeps),
        probe_force_(probe_force(lumped, parameters.step)) {
    for (auto* checkpoint : {&start_, &end_}) motion_.save(*checkpoint);  // allocates here, so that steps do not
    if (substeps(parameters.step) <= maximum_substeps_) return;
    SetupProblem p;
    p.what = "a step of " + number(parameters.step) + " s takes " + number(parameters.step / motion_.limit()) +
             " stable steps of " + number(motion_.limit()) + " s";
    p.hint = "Shorten the step, make the smallest and stiffest elements larger, or choose Implicit";
    p.value = parameters.step / motion_.limit();
    p.threshold = maximum_substeps_;
    raise(std::move(p));
  }

  MotionStep step(double h) noexcept override {
    motion_.save(start_);
    length_ = h;
    return run_substeps();
  }
  bool correct(const VectorX& more) noexcept override {
    if (!(length_ > 0.0)) return false;
    motion_.save(end_);
    motion_.return_to(start_);
    motion_.load() += more;
    if (run_substeps().status.ok()) return true;
    motion_.return_to(end_);
    motion_.load() -= more;
    return false;
  }
  bool prepare_response(double h) noexcept override {
    motion_.save(start_);
    length_ = h;
    if (!run_substeps().taken) return false;
    unloaded_ = motion_.state().displacement;
    motion_.return_to(start_);
    return true;
  }
  bool respond(const VectorX& forces, VectorX& u) noexcept override {
    const double largest = forces.template lpNorm<Eigen::Infinity>();
    if (!(largest > 0.0)) return false;
    const double scale = probe_force_ / largest;
    motion_.load() += scale * forces;
    const bool taken = run_substeps().taken;
    u = (motion_.state().displacement - unloaded_) / scale;
    motion_.return_to(start_);
    motion_.load() -= scale * forces;
    length_ = taken ? length_ : 0.0;
    return taken;
  }
  const VectorX& displacement() const noexcept override { return motion_.state().displacement; }
  const VectorX& velocity() const noexcept override { return motion_.state().velocity; }

  void rest_at(const VectorX& u) override {
    VectorX placed = u;
    for (const Index dof : motion_.state().constrained) placed[dof] = prescribed_[dof];
    motion_.set(placed, VectorX::Zero(u.size()));
    length_ = 0.0;
  }
  void set_load(const VectorX& load) override {
    require_entries(load, motion_.load().size());
    motion_.load() = load;
  }
  void set_prescribed(const VectorX& values) override {
    require_entries(values, prescribed_.size());
    prescribed_ = values;
  }

 private:
  /// Force [N] that displaces the lightest node within a step by about the length that force differences can resolve.
  double probe_force(const VectorX& lumped, double step) {
    return motion_.force().probe_length() * lumped.minCoeff() / (step * step);
  }
  double substeps(double h) const noexcept { return std::max(1.0, std::ceil(h / motion_.limit())); }

  /// Steps from the current state over `length_`; prescribed dofs move to their prescribed values at constant speed.
  MotionStep run_substeps() noexcept {
    MotionStep done;
    const double count = substeps(length_);
    if (!(count <= maximum_substeps_)) {
      done.status.set(StatusFlag::step_refused);
      return done;
    }
    int left = static_cast<int>(count);
    double dt = length_ / count;
    for (int most = maximum_substeps_; left > 0 && most > 0; --left, --most) {
      if (dt > motion_.limit()) {  // which is estimated again on the way, and may have become shorter
        const double rest = left * dt, more = std::max(left + 1.0, substeps(rest));
        if (!(more <= most)) break;
        left = static_cast<int>(more);
        dt = rest / more;
      }
      for (const Index dof : motion_.state().constrained) {
        const double from = motion_.state().displacement[dof];
        motion_.target()[dof] = from + (prescribed_[dof] - from) / left;
      }
      done.status |= motion_.step(dt);
    }
    if (left > 0) done.status.set(StatusFlag::step_refused);
    done.deformation = motion_.deformation();
    done.taken = !done.status.has(StatusFlag::energy_grew) && !done.status.has(StatusFlag::step_refused);
    return done;
  }

  ExplicitMotion<Force, Scheme> motion_;
  VectorX prescribed_, unloaded_;
  int maximum_substeps_;
  double probe_force_;
  double length_ = 0.0;  // of the last step; 0: there is no step to correct
  typename ExplicitMotion<Force, Scheme>::Checkpoint start_, end_;
};

/// Whether the materials of a body are viscoelastic.
template <class MaterialBody>
inline constexpr bool has_history = false;
template <Element E>
inline constexpr bool has_history<ViscousBody<E>> = true;
template <Element E, ViscousMaterial M>
inline constexpr bool has_history<HyperelasticBody<E, M>> = true;

}  // namespace detail

template <class Scheme>
struct SolverTraits<Explicit<Scheme>> {
  using Parameters = ExplicitParameters;

  template <class MaterialBody>
  static PreparedMotion make_motion(MaterialBody body, const Scene& scene, const Parameters& p,
                                    const SetupLimits& limits) {
    static_assert(!detail::has_history<MaterialBody>,
                  "palpate: explicit steps do not support viscoelastic materials; use Implicit<Newton>");
    const Body rest = detail::rest_body(body);
    return make_motion(rest, std::move(body), scene, p, limits);
  }

 private:
  template <Element E, class MaterialBody>
  static PreparedMotion make_motion(const Body<E>& rest, MaterialBody body, const Scene& scene, const Parameters& p,
                                    const SetupLimits& limits) {
    PreparedMotion made;
    made.accepts_initial_strains = requires {
      body.mesh;
    };
    made.large_strain = !made.accepts_initial_strains;
    made.start = VectorX::Zero(3 * rest.mesh.node_count());
    if (p.settle) {
      Equilibrium statics(make_constrained_body(body, scene, limits), limits);
      made.start = detail::settled(statics);
    }
    const auto conditions = resolve_essential(rest.mesh, extract_boundary<E>(rest.mesh), scene);
    const VectorX lumped = lumped_mass(rest);
    const double bound = element_frequency_bound(rest);
    made.motion = make(make_force(std::move(body), limits), lumped, conditions, bound, p);
    return made;
  }
  template <class Force>
  static std::unique_ptr<TissueMotion> make(Force force, const VectorX& lumped, const EssentialConditions& conditions,
                                            double bound, const Parameters& p) {
    return std::make_unique<detail::ExplicitTissueMotion<Force, Scheme>>(std::move(force), lumped, conditions, bound,
                                                                         p);
  }
  template <HyperelasticMaterial M>
  static auto make_force(HyperelasticBody<Tet4, M> body, const SetupLimits& limits) {
    detail::require_no_fibres(body);
    return BatchedTetrahedra<M>(body, limits);
  }
  template <Element E, LargeStrainMaterial M>
  static auto make_force(HyperelasticBody<E, M> body, const SetupLimits& limits) {
    return LargeStrain<E, M>(std::move(body), limits);
  }
  template <Element E>
  static auto make_force(Body<E> body, const SetupLimits& limits) {
    return LinearForces(assemble_stiffness<E>(body, limits));
  }
};

}}  // namespace palpate
