// Motion of a body that is at large strain near the tools only.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/body_parts.hpp>
#include <palpate/model/moving/detail/far_displacement.hpp>
#include <palpate/model/moving/detail/linear_surroundings.hpp>
#include <palpate/model/moving/detail/quasi_newton_motion.hpp>
#include <palpate/model/moving/detail/renewable_factor.hpp>
#include <palpate/model/moving/tissue_motion.hpp>

#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A motion without inertia of the near part, with the far part as its linear surroundings. A step moves the near part
/// only; `complete` adds the displacement of the far part, by half a solve with its factor. `displacement` and
/// `respond` are therefore right on nodes of the near part only. Status of a step: large_displacement where the far
/// part is displaced by too much for linear elasticity (FarDisplacement, largest_linear_displacement).
class PartlyLinearMotion final : public TissueMotion {
 public:
  /// `near` is the motion of the near part with SurroundedForces, at rest under `load`; `positions` are those of the
  /// body at rest [m].
  PartlyLinearMotion(BodyParts parts, std::unique_ptr<TissueMotion> near,
                     std::unique_ptr<LinearSurroundings> surroundings, const VectorX& load,
                     const std::vector<Vector3>& positions);

  MotionStep step(double h) noexcept override;
  /// Nothing to do: the next step forgets this one.
  bool correct(const VectorX&) noexcept override { return stepped_; }
  bool set_springs(std::span<const ContactSpring> springs) noexcept override;
  bool prepare_response(double h) noexcept override { return near_->prepare_response(h); }
  bool respond(const VectorX& forces, VectorX& u) noexcept override;
  bool is_static() const noexcept override { return near_->is_static(); }
  const VectorX& displacement() const noexcept override { return u_; }
  const VectorX& velocity() const noexcept override { return v_; }
  void rest_at(const VectorX& u) override;
  void set_load(const VectorX& load) override;
  void set_prescribed(const VectorX& values) override;
  void complete(VectorX& u) noexcept override;

  const TissueMotion& near() const noexcept { return *near_; }
  const BodyParts& parts() const noexcept { return parts_; }

 private:
  /// Takes over the displacement of the near part, and of the far part with the interface fixed where it has changed.
  void take_displacement() noexcept;
  void load_near() noexcept;

  BodyParts parts_;
  std::unique_ptr<LinearSurroundings> surroundings_;
  std::unique_ptr<TissueMotion> near_;      // refers to the stiffness of the surroundings
  std::vector<Index> kept_, kept_in_body_;  // the kept dofs of the surroundings in the near part, and in the body
  FarDisplacement far_displacement_;
  VectorX u_, v_, load_;  // of all nodes
  VectorX near_vector_, far_vector_;
  VectorX kept_moved_, extended_;       // for `complete`
  std::vector<ContactSpring> springs_;  // by nodes of the near part
  bool stepped_ = false, far_changed_ = true;
};

namespace detail {

/// The motion of a body whose near part has these forces, stiffness at rest and after displacement, and pattern.
/// `whole` has the conditions, loads and masses of all nodes. Throws as QuasiNewtonMotion.
PreparedMotion prepare_partly_linear(DeformableBody whole, BodyParts parts, const BlockPattern& near_pattern,
                                     const BlockMatrix& near_stiffness, StiffnessAt near_stiffness_at,
                                     std::unique_ptr<EnergyForces> near_forces,
                                     std::unique_ptr<LinearSurroundings> surroundings,
                                     const QuasiNewtonParameters& parameters, const SetupLimits& limits);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/partly_linear_motion.ipp>
#endif
