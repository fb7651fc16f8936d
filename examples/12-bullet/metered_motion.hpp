// A motion of tissue whose energy is measured: a solver policy around another one.
#pragma once

#include <palpate/assembly/large_strain.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>

#include <memory>
#include <utility>

namespace bullet_example {

using palpate::VectorX;

/// Forwards everything to another motion, and measures the energy of the tissue and the work of its loads. The state of
/// a step is final when the next step begins: until then `correct` may change it.
class MeteredMotion final : public palpate::TissueMotion {
 public:
  MeteredMotion(std::unique_ptr<TissueMotion> motion, std::unique_ptr<palpate::ElasticForces> elastic, VectorX mass)
      : motion_(std::move(motion)), elastic_(std::move(elastic)), mass_(std::move(mass)) {
    load_ = u_ = VectorX::Zero(mass_.size());
  }

  double kinetic_energy() const { return kinetic_; }             ///< [J]
  double stored_energy() const { return elastic_->energy(u_); }  ///< [J]; evaluates all elements
  double work() const { return work_; }                          ///< of the loads, which are those of the tools [J]
  const VectorX& final_displacement() const { return u_; }

  palpate::MotionStep step(double h) noexcept override {
    work_ += load_.dot(motion_->displacement() - u_);
    u_ = motion_->displacement();
    kinetic_ = 0.5 * motion_->velocity().dot(mass_.cwiseProduct(motion_->velocity()));
    return motion_->step(h);
  }
  void set_load(const VectorX& load) override {
    motion_->set_load(load);
    load_ = load;
  }
  void rest_at(const VectorX& u) override {
    motion_->rest_at(u);
    u_ = motion_->displacement();
    kinetic_ = work_ = 0.0;
  }
  bool correct(const VectorX& more) noexcept override { return motion_->correct(more); }
  bool prepare_response(double h) noexcept override { return motion_->prepare_response(h); }
  bool respond(const VectorX& forces, VectorX& u) noexcept override { return motion_->respond(forces, u); }
  const VectorX& displacement() const noexcept override { return motion_->displacement(); }
  const VectorX& velocity() const noexcept override { return motion_->velocity(); }
  void set_prescribed(const VectorX& values) override { motion_->set_prescribed(values); }

 private:
  std::unique_ptr<TissueMotion> motion_;
  std::unique_ptr<palpate::ElasticForces> elastic_;
  VectorX mass_, load_, u_;
  double kinetic_ = 0.0, work_ = 0.0;
};

/// A solver policy: the motion of `Solver`, metered.
template <class Solver>
struct Metered {};

}  // namespace bullet_example

template <class Solver>
struct palpate::SolverTraits<bullet_example::Metered<Solver>> {
  using Parameters = typename SolverTraits<Solver>::Parameters;

  template <Element E, LargeStrainMaterial M>
  static PreparedMotion make_motion(const HyperelasticBody<E, M>& body, const Scene& scene, const Parameters& p,
                                    const SetupLimits& limits) {
    const VectorX lumped = lumped_mass(body.rest);
    VectorX mass(3 * lumped.size());
    for (Index i = 0; i < lumped.size(); ++i) mass.segment<3>(3 * i).setConstant(lumped[i]);
    PreparedMotion made = SolverTraits<Solver>::make_motion(body, scene, p, limits);
    made.motion = std::make_unique<bullet_example::MeteredMotion>(
        std::move(made.motion), std::make_unique<LargeStrain<E, M>>(body, limits), std::move(mass));
    return made;
  }
};
