// Motion of a body that is at large strain near the tools only.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/model/moving/detail/body_parts.hpp>
#include <palpate/model/moving/detail/quasi_newton_motion.hpp>
#include <palpate/model/moving/detail/renewable_factor.hpp>
#include <palpate/model/moving/tissue_motion.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A linear body at rest under its loads, as a stiffness and forces on its interface: exact static condensation.
/// Vectors have 3 entries per node of the part. Only the constructor allocates or throws.
class LinearSurroundings {
 public:
  /// Throws not_positive_definite, too_large or cancelled.
  LinearSurroundings(BlockMatrix stiffness, EssentialConditions conditions, const std::vector<Vector3>& positions,
                     const std::vector<NodeId>& interface_nodes, const SetupLimits& limits);

  bool is_interface(std::size_t node) const noexcept { return is_interface_[node] != 0; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  /// Free dofs of the interface, ascending.
  const std::vector<Index>& kept() const noexcept { return kept_; }
  /// Their stiffness, kept x kept [N/m].
  const MatrixX& stiffness() const noexcept { return schur_; }

  /// Sets loads [N], or prescribed values [m]; one solve when they have changed. Loads on interface nodes and values of
  /// free dofs are ignored. Returns whether there was a change.
  bool set_load(const VectorX& load) noexcept;
  bool set_prescribed(const VectorX& values) noexcept;

  /// Displacement while the kept dofs do not move [m], and force on these dofs [N].
  struct Still {
    VectorX displacement, kept_load;
  };
  const Still& from_load() const noexcept { return from_load_; }
  const Still& from_prescribed() const noexcept { return from_prescribed_; }
  /// Their sum on kept dof i [N].
  double kept_load(Index i) const noexcept { return from_load_.kept_load[i] + from_prescribed_.kept_load[i]; }
  /// Displacement u of the free dofs for a displacement of the kept dofs, without loads. Half a solve. May run in
  /// another thread than the other functions.
  void extend(const VectorX& kept, VectorX& u) noexcept;

 private:
  /// Solves for `full_` with the kept dofs fixed; prescribed components are not set.
  void solve(Still& still) noexcept;

  BlockMatrix stiffness_;
  EssentialConditions conditions_;
  std::vector<std::uint8_t> is_interface_;  // per node
  std::vector<Index> kept_;
  SparseCholesky interior_;
  MatrixX schur_;
  SparseCholesky extension_;  // shares the factor, with its own workspace
  VectorX load_, full_, free_;
  Still from_load_, from_prescribed_;
  VectorX zeros_;     // of the kept dofs
  VectorX extended_;  // free dofs
};

/// Energy and force of a part at large strain and of its linear surroundings, at a displacement of the part. Refers to
/// the surroundings' stiffness, which must outlive it.
class SurroundedForces final : public EnergyForces {
 public:
  /// `kept`: dofs of the part, in the order of the stiffness.
  SurroundedForces(std::unique_ptr<EnergyForces> part, const MatrixX& stiffness, std::vector<Index> kept)
      : part_(std::move(part)),
        stiffness_(stiffness),
        kept_(std::move(kept)),
        moved_(stiffness.rows()),
        pulled_(stiffness.rows()) {}
  Index size() const noexcept override { return part_->size(); }
  double evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept override;
  double rounding() const noexcept override { return part_->rounding(); }
  double evaluate_rotated(const std::vector<Vector3>& positions, VectorX& u, VectorX& f) noexcept override {
    return part_->evaluate_rotated(positions, u, f);
  }

 private:
  std::unique_ptr<EnergyForces> part_;
  const MatrixX& stiffness_;
  std::vector<Index> kept_;
  VectorX moved_, pulled_;
};

/// Dofs of `part` for dofs of `other`, both parts of one mesh.
std::vector<Index> dofs_in(const BodyPart& part, const BodyPart& other, const std::vector<Index>& dofs);

/// The stiffness of a part and of its surroundings, on the pattern that both need.
class SurroundedStiffness {
 public:
  /// `dense` is the stiffness of the surroundings on these dofs of the part, ascending. Throws too_large.
  SurroundedStiffness(const BlockPattern& part, const MatrixX& dense, const std::vector<Index>& dofs,
                      const SetupLimits& limits);

  const BlockPattern& pattern() const noexcept { return surroundings_.pattern(); }
  /// Sets `sum`, a matrix on `pattern`. No allocation.
  void add_up(const BlockMatrix& part, BlockMatrix& sum) const noexcept;

 private:
  BlockMatrix surroundings_;
  std::vector<Index> position_;  // of every block of the part
};

/// Estimates the largest displacement of a far part, up to a translation, without computing it: from its loads, from
/// the spread of the interface and of the supports, and from the rotation of the interface, which a part that hangs on
/// it follows. Only the constructor allocates.
class FarDisplacement {
 public:
  /// `positions` of the body at rest [m]; displacements above `largest` [m] are too large.
  FarDisplacement(const BodyParts& parts, const std::vector<Vector3>& positions, LinearSurroundings& surroundings,
                  double largest);

  /// Takes over the displacement of the far part by its loads alone, 3 per node of the part [m].
  void set_from_load(const VectorX& u) noexcept;
  /// Whether a displacement of the body, 3 per node [m], displaces its far part by too much. Reads the interface and
  /// the prescribed components.
  bool is_too_large(const VectorX& u) noexcept;

 private:
  struct Support {
    NodeId node;  // of the body
    std::uint8_t constrained;
  };
  std::vector<NodeId> interface_;
  std::vector<Vector3> arm_;  // of the interface, from its centre
  Matrix3 inverse_inertia_ = Matrix3::Zero();
  Vector3 reach_ = Vector3::Zero();  // largest displacement of the far part per rotation of the interface [m]
  std::vector<Support> supports_;
  std::vector<Vector3> displaced_, loaded_;
  double largest_;
  bool loads_displace_ = false;
};

/// A motion without inertia of the near part, with the far part as its linear surroundings. A step moves the near part
/// only; `complete` adds the displacement of the far part, by half a solve with its factor. `displacement` and
/// `respond` are therefore right on nodes of the near part only. Status of a step: large_displacement where the far
/// part is displaced by too much for linear elasticity (FarDisplacement, largest_linear_displacement).
class PartlyLinearMotion final : public TissueMotion {
 public:
  /// `near` is the motion of the near part with SurroundedForces, at rest under `load`; `positions` are those of the
  /// body at rest [m].
  PartlyLinearMotion(BodyParts parts, std::unique_ptr<TissueMotion> near_motion,
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

  const TissueMotion& near_motion() const noexcept { return *near_; }

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

/// The motion of a body whose near part has these forces, stiffness at rest and after displacement, and pattern.
/// `whole` has the conditions, loads and masses of all nodes. Throws as QuasiNewtonMotion.
PreparedMotion prepare_partly_linear(DeformableBody whole, BodyParts parts, const BlockPattern& near_pattern,
                                     const BlockMatrix& near_stiffness, StiffnessAt near_stiffness_at,
                                     std::unique_ptr<EnergyForces> near_forces,
                                     std::unique_ptr<LinearSurroundings> surroundings,
                                     const QuasiNewtonParameters& parameters, const SetupLimits& limits);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/partly_linear_motion.ipp>
#endif
