// TissueMotion with implicit steps by Newton's method.
#pragma once

#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/model/moving/tissue_motion.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Wraps an ImplicitDynamics. A step whose iterations end early may leave a residual of a twentieth of the force.
class ImplicitMotion final : public TissueMotion {
 public:
  static constexpr double tolerable_residual = 0.05;

  ImplicitMotion(DeformableBody body, const DynamicsParameters& parameters, const SetupLimits& limits);

  MotionStep step(double h) noexcept override;
  bool correct(const VectorX& more) noexcept override;
  bool set_springs(std::span<const ContactSpring> springs) noexcept override;
  bool prepare_response(double h) noexcept override;
  bool respond(const VectorX& forces, VectorX& u) noexcept override;
  bool respond_here(const VectorX& forces, VectorX& u) noexcept override;
  const VectorX& displacement() const noexcept override;
  const VectorX& velocity() const noexcept override;
  void rest_at(const VectorX& u) override;
  void set_load(const VectorX& load) override;
  void set_prescribed(const VectorX& values) override;

 private:
  ImplicitDynamics motion_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/implicit_motion.ipp>
#endif
