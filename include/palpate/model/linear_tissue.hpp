// Linear static tissue without its element, material and solver: what a session and a program see of a HapticFEModel.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/mesh/admission_policy.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/contact_compliance.hpp>
#include <palpate/model/setup_report.hpp>

#include <Eigen/Geometry>

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class AnyStiffness;
class ElasticBody;
class Statics;
struct AdmittedBody;
struct SolverRecipe;

/// What a caller may decide about a model's set-up.
struct SetupOptions {
  ProgressCallback progress{};  ///< may cancel
  std::size_t memory_limit =
      std::numeric_limits<std::size_t>::max();  ///< [bytes]; more is refused as too_large before it is allocated
  AdmissionPolicy admission{};
  int compliance_slots = 256;  ///< vertices whose compliance is remembered by a solver that does not store all
  /// When such a solver computes it. `automatic` decides by the numbers that a column reads, the same way on every
  /// machine: beyond 100 000, some 50 us, a thread computes it; the report says which.
  ColumnFill columns = ColumnFill::automatic;
  std::string cache_file{};  ///< where the prepared system is kept for the next time; empty: nowhere. See docs/cache.md
};

/// The part of HapticFEModel that is no template of element, material or solver. Scalar, float or double, is what the
/// stored compliance is. Not made by itself: HapticFEModel derives from it. Satisfies TissueModel.
template <std::floating_point Scalar>
class LinearTissue {
 public:
  const SetupReport& report() const noexcept { return report_; }
  /// Where the admitted mesh's frame lies in the mesh as given [m].
  const Vector3& origin() const noexcept { return origin_; }
  /// New id of every node as given, -1 for those dropped at admission.
  const std::vector<NodeId>& node_map() const noexcept { return node_map_; }
  /// Resting position of an admitted node, in the frame of the mesh as given [m].
  Vector3 rest_position(NodeId node) const noexcept;
  /// Node of every vertex of the contact surface.
  const std::vector<NodeId>& touchable_nodes() const noexcept { return touchable_; }
  const std::vector<NodeId>& seen_nodes() const noexcept { return seen_; }

  /// Displacement under the scene's loads, no tool: 3 per admitted node [m].
  const VectorX& displacement() const noexcept;
  /// K u - f_0: forces with which the body answers, 3 per admitted node [N].
  VectorX internal_force() const;
  /// Forces of the supports, zero on free dofs, 3 per admitted node [N].
  VectorX reactions() const;
  double strain_energy() const;

  /// Displacement with these forces on the contact surface, for drawing: one back-substitution. u has 3 entries per
  /// admitted node [m]. Resizes u when it has another size, which allocates; otherwise it does not. A force on a
  /// vertex that does not exist is left out, and the report says not converged. May run beside a tick, but not twice at
  /// once.
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept;
  /// The same as a new vector; allocates. Throws index_out_of_range for a vertex that does not exist, non_finite for a
  /// force that is not finite, not_converged for a solve that stopped early.
  VectorX displacement(std::span<const VertexForce> forces);

  /// Replaces loads and prescribed values. Throws unsupported for another set of prescribed components, and when the
  /// scene lets tools touch other nodes or faces than the model was made for. A scene without touch() keeps
  /// the touched set; see() is ignored. Strong guarantee.
  void set_conditions(const Scene& scene);
  /// Gravity [m/s^2] in the world's frame. Strong guarantee.
  void set_gravity(const Vector3& gravity);
  /// Where the organ lies in the world; turns gravity with it. Throws bad_argument unless it is a rigid motion. Strong
  /// guarantee.
  void set_pose(const Eigen::Isometry3d& pose);
  /// What was set: from the frame of the mesh as given to the world's.
  const Eigen::Isometry3d& pose() const noexcept { return pose_; }
  /// Back to the scene and pose of construction. Strong guarantee.
  void reset();

  // TissueModel
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int> vertices) noexcept { return compliance_.require(vertices); }
  void foresee(std::span<const int> vertices) noexcept { compliance_.foresee(vertices); }
  auto compliance(int i, int j) const noexcept { return compliance_(i, j); }
  double compliance_bound(int j) const noexcept { return compliance_.bound(j); }
  std::uint64_t compliance_revision() const noexcept { return compliance_.revision(); }
  double compliance_floor() const noexcept { return compliance_floor_; }
  /// From the frame of the contact surface, whose origin is `origin()`, to the world's.
  const Eigen::Isometry3d& to_world() const noexcept { return world_; }

 protected:
  using MakeStiffness = AnyStiffness (*)(const ElasticBody&, const SetupLimits&);

  explicit LinearTissue(const SetupOptions& options);
  LinearTissue(const LinearTissue&) = delete;
  LinearTissue& operator=(const LinearTissue&) = delete;
  LinearTissue(LinearTissue&&) noexcept;
  LinearTissue& operator=(LinearTissue&&) noexcept;
  ~LinearTissue();

  const SetupLimits& limits() const noexcept { return limits_; }
  SetupReport& setup_report() noexcept { return report_; }
  /// The body given to `set_up`.
  const ElasticBody& elastic_body() const noexcept;

  /// All of the set-up that comes after admission. Throws what Statics and ContactCompliance throw.
  void set_up(const Scene& scene, AdmittedBody admitted, MakeStiffness make_stiffness, const SolverRecipe& recipe,
              const SetupOptions& options);

 private:
  /// Refuses a scene that lets tools touch something else.
  void require_same_touch(const Scene& mapped) const;
  void prepare_contact(const std::vector<Triangle>& triangles, bool eager, const SetupOptions& options);
  /// Kept dof of every touchable dof, -1 when it is prescribed.
  std::vector<Index> kept_index() const;
  /// Computes a few columns: how soft the surface is, and how long a column takes; starts a thread where one is to
  /// compute the others.
  void sample_columns(ColumnFill fill);
  /// Whether the three solves for a vertex would make a tick late.
  bool is_column_late() const;
  Vector3 deformed(NodeId node) const noexcept;
  /// For changes of the loads: what is to be said of their displacement is said before they are accepted.
  std::function<void(const VectorX&)> reporting_to(SetupReport& report) const;
  void accept_displacement(SetupReport& report) noexcept;
  void place(const Eigen::Isometry3d& pose) noexcept;
  void move_surface() noexcept;

  SetupLimits limits_;
  SetupReport report_;
  Scene scene_;
  std::vector<NodeId> node_map_, touchable_, seen_;
  OriginalIds original_ids_;
  Vector3 origin_ = Vector3::Zero(), gravity_ = Vector3::Zero();
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity(), world_ = Eigen::Isometry3d::Identity();
  std::unique_ptr<Statics> statics_;
  ContactCompliance<Scalar> compliance_;
  double compliance_floor_ = 0.0;
  ContactSurface surface_;
  std::vector<Vector3> moved_;
  std::string loads_;  // without gravity
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/linear_tissue.ipp>
#endif
