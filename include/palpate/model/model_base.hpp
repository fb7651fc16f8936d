// Common base of all models, for any solver: the admitted body, the report, and the pose in the world.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/admission_policy.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/cache/cache_file.hpp>
#include <palpate/model/force_error_options.hpp>
#include <palpate/model/setup_report.hpp>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class ElasticBody;
namespace detail {

struct AdmittedBody;
struct Touchable;

}  // namespace detail

/// When a solver that does not store the whole compliance computes a column.
enum class ColumnFill : std::uint8_t {
  automatic,    ///< synchronous when a column is cheap, asynchronous when it would delay a tick
  synchronous,  ///< in the tick that first needs it: exact in every tick; the duration of a tick is not bounded
  asynchronous  ///< in a background thread, for all vertices near a tool; a tick without a needed column reports
                ///< degraded_model
};

/// Options for the set-up of any model.
struct SetupOptions {
  ProgressCallback progress{};  ///< may cancel
  std::size_t memory_limit =
      std::numeric_limits<std::size_t>::max();  ///< [bytes]; more is refused as too_large before it is allocated
  AdmissionPolicy admission{};
  /// A number of threads, 0 for as many as the machine has, or an executor. While a haptic loop runs, leave it a core.
  SetupThreads threads{};

  // For static models. Other solvers ignore the first three and refuse the last.
  int compliance_slots = 256;  ///< vertices whose compliance a solver keeps that does not store all columns
  /// When such a solver computes a column. `automatic` decides by the count of numbers that a column reads, so the
  /// decision is the same on every machine: above 100 000 (some 50 us) a background thread computes it. The report
  /// states which.
  ColumnFill columns = ColumnFill::automatic;
  ForceErrorOptions force_error{};  ///< `measured_force_error()`: ticks give the error of their forces
  CacheFile cache_file{};           ///< stores the prepared system for the next set-up; empty: none. See docs/cache.md
};

/// The part of HapticFEModel that does not depend on element, material or solver. Base of all models.
///
/// Frames: `set_pose` of a model places the frame of the mesh as given in the world of the tools. Forces and
/// displacements have the axes of that mesh. Positions of `mesh()` and of the contact surface have these axes, too, and
/// are relative to `origin()`; `to_world()` maps them to the world.
class ModelBase {
 public:
  const SetupReport& report() const noexcept { return report_; }
  /// The sentences of its remarks, for the reports of sessions.
  std::vector<std::string> notes() const;
  /// Whether the set-up refused what looks like other units (AdmissionPolicy::units); servos then refuse such tools.
  bool refuses_suspicious_units() const noexcept { return refuses_units_; }
  /// Origin of the frame of the admitted mesh, in the frame of the mesh as given [m].
  const Vector3& origin() const noexcept { return origin_; }
  /// New id of every node of the mesh as given, -1 for nodes dropped at admission.
  const std::vector<NodeId>& node_map() const noexcept { return node_map_; }
  /// Rest position of an admitted node, in the frame of the mesh as given [m].
  Vector3 rest_position(NodeId node) const noexcept;
  /// Node of every vertex of the contact surface.
  const std::vector<NodeId>& touchable_nodes() const noexcept { return touchable_; }
  const std::vector<NodeId>& rendered_nodes() const noexcept { return rendered_; }
  /// Pose set last: maps the frame of the mesh as given to the world frame.
  const Eigen::Isometry3d& pose() const noexcept { return pose_; }
  /// Maps the frame of the contact surface, whose origin is `origin()`, to the world frame.
  const Eigen::Isometry3d& to_world() const noexcept { return world_; }

 protected:
  explicit ModelBase(const SetupOptions& options);
  ModelBase(const ModelBase&) = delete;
  ModelBase& operator=(const ModelBase&) = delete;
  ModelBase(ModelBase&&) noexcept;
  ModelBase& operator=(ModelBase&&) noexcept;
  ~ModelBase();

  const SetupLimits& limits() const noexcept { return limits_; }
  SetupReport& setup_report() noexcept { return report_; }
  /// The body given to `admit`.
  const ElasticBody& elastic_body() const noexcept { return *body_; }
  ElasticBody& elastic_body() noexcept { return *body_; }
  OriginalIds& original_ids() noexcept { return original_ids_; }

  /// Takes over an admitted body and resolves its touchable and rendered parts. Reports values that look like other
  /// units, and a touchable part that is fixed. Throws the errors of resolving, and suspicious_units if the admission
  /// policy refuses such values.
  detail::Touchable admit(const Scene& scene, detail::AdmittedBody admitted);
  /// The scene of the set-up, with the ids of the admitted mesh.
  const Scene& scene() const noexcept { return scene_; }
  /// The scene with the ids of the admitted mesh. Throws unsupported when its touchable nodes or faces differ from the
  /// touchable nodes and `triangles` of the model.
  Scene mapped(const Scene& scene, const std::vector<Triangle>& triangles) const;

  /// Gravity [m/s^2], world frame.
  const Vector3& gravity() const noexcept { return gravity_; }
  /// Description of the loads on the body other than gravity.
  const std::string& other_loads() const noexcept { return other_loads_; }
  void keep_gravity(const Vector3& gravity) noexcept { gravity_ = gravity; }
  void keep_loads(const Vector3& gravity, std::string& others) noexcept {
    gravity_ = gravity;
    other_loads_.swap(others);
  }
  /// Rest positions of the touchable nodes, and a description of the loads on the body.
  ContactSurface::Unloaded unloaded() const;
  /// Gravity given in the world frame, expressed in the frame of a body at `pose`.
  static Vector3 local(const Vector3& gravity, const Eigen::Isometry3d& pose) noexcept;
  /// Throws non_finite.
  static void require_finite_gravity(const Vector3& gravity);
  /// Throws bad_argument unless the pose is a rigid motion.
  static void require_rigid(const Eigen::Isometry3d& pose);
  void place(const Eigen::Isometry3d& pose) noexcept;

 private:
  SetupLimits limits_;
  SetupReport report_;
  Scene scene_;
  std::vector<NodeId> node_map_, touchable_, rendered_;
  OriginalIds original_ids_;
  std::unique_ptr<ElasticBody> body_;
  std::string other_loads_;
  Vector3 origin_ = Vector3::Zero(), gravity_ = Vector3::Zero();
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity(), world_ = Eigen::Isometry3d::Identity();
  bool refuses_units_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/model_base.ipp>
#endif
