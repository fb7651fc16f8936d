// The composition: element, material and solver make a tissue that can be touched.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/smoothed_strain.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/linear_solver.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/bvh.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/admission_policy.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/contact_compliance.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/stage_timer.hpp>
#include <palpate/model/statics.hpp>
#include <palpate/model/touchable.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// What a caller may decide about a model's set-up.
struct SetupOptions {
  ProgressCallback progress{};  ///< may cancel
  std::size_t memory_limit =
      std::numeric_limits<std::size_t>::max();  ///< [bytes]; more is refused as too_large before it is allocated
  int threads = 1;
  AdmissionPolicy admission{};
  int compliance_slots = 256;  ///< vertices whose compliance is remembered by a solver that does not store all
  ColumnFill columns = ColumnFill::in_tick;  ///< when such a solver computes it
  std::string cache_file{};  ///< where the prepared system is kept for the next time; empty: nowhere. See docs/cache.md
};

/// Linear static tissue. `E` is the element, `M` the material, `Solver` a policy of model/policies.hpp; assembly,
/// quadrature and condensation come with them. The model is prepared once and copies what it needs from mesh and scene.
/// Afterwards it changes through named calls only (loads, prescribed values, gravity, pose, reset), none of which
/// refactorises; none may run while a tick does. Satisfies TissueModel.
///
/// Frames: nodes, forces and displacements are in the model's frame, which is the mesh's; `set_pose` places it in the
/// world of the tools.
template <Element E, LinearMaterial M, SolverPolicy Solver = Condensed<SelectiveInverse>>
class HapticFEModel {
 public:
  static_assert(has_triangulated_faces<E>(),
                "palpate: tools touch triangles; give the element's Face a list `triangles` of its nodes, like Tri6");
  using ElementType = E;
  using Traits = SolverTraits<Solver>;

  /// One material everywhere. Throws SetupError; see docs/errors.md for the kinds.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const M& material, const SetupOptions& options = {})
      : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}

  /// One material per region.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {})
      : limits_{options.progress, options.memory_limit, options.threads} {
    prepare(mesh, scene, materials, options);
  }

  const SetupReport& report() const noexcept { return report_; }
  /// The admitted mesh, in the frame of `origin()`.
  const Mesh<E>& mesh() const noexcept { return statics_->body().mesh; }
  /// Where the admitted mesh's frame lies in the mesh as given [m].
  const Vector3& origin() const noexcept { return origin_; }
  /// New id of every node as given, -1 for those dropped at admission.
  const std::vector<NodeId>& node_map() const noexcept { return node_map_; }
  /// Resting position of an admitted node, in the frame of the mesh as given [m].
  Vector3 rest_position(NodeId node) const noexcept { return origin_ + mesh().position(node); }
  /// Node of every vertex of the contact surface.
  const std::vector<NodeId>& touchable_nodes() const noexcept { return touchable_; }
  const std::vector<NodeId>& seen_nodes() const noexcept { return seen_; }
  const std::vector<BoundaryFace<E>>& boundary() const noexcept { return statics_->boundary(); }
  const Body<E>& body() const noexcept { return statics_->body(); }

  /// Displacement under the scene's loads, no tool: 3 per admitted node [m].
  const VectorX& displacement() const noexcept { return statics_->displacement(); }
  VectorX internal_force() const { return statics_->internal_force(); }
  VectorX reactions() const { return statics_->reactions(); }
  double strain_energy() const { return palpate::strain_energy(statics_->body(), statics_->displacement()); }

  /// Displacement with these forces on the contact surface, for drawing: one back-substitution. u has 3 entries per
  /// node. No allocation; may run beside a tick, but not twice at once.
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept {
    return statics_->displacement_with(forces, touchable_, u);
  }

  /// Replaces loads and prescribed values; the set of prescribed components and of touched nodes must stay. Strong
  /// guarantee.
  void set_conditions(const Scene& scene) {
    const Scene mapped = scene.mapped(node_map_);
    SetupReport report = report_;
    statics_->set_conditions(mapped, pose_.linear().transpose() * scene.gravity(), reporting_to(report));
    gravity_ = scene.gravity();
    accept_displacement(report);
  }
  /// Gravity [m/s^2] in the world's frame. Strong guarantee.
  void set_gravity(const Vector3& gravity) {
    if (!gravity.allFinite()) raise(SetupErrorKind::non_finite, "gravity is not finite");
    SetupReport report = report_;
    statics_->set_gravity(pose_.linear().transpose() * gravity, reporting_to(report));
    gravity_ = gravity;
    accept_displacement(report);
  }
  /// Where the organ lies in the world; turns gravity with it. Throws bad_argument unless it is a rigid motion. Strong
  /// guarantee.
  void set_pose(const Eigen::Isometry3d& pose) {
    const bool rigid = pose.matrix().allFinite() &&
                       (pose.linear().transpose() * pose.linear() - Matrix3::Identity()).norm() < 1e-9 &&
                       pose.linear().determinant() > 0.0;
    if (!rigid)
      raise(SetupErrorKind::bad_argument, "the pose is not a rigid motion",
            "Give a proper rotation and a finite translation");
    SetupReport report = report_;
    if (!gravity_.isZero(0.0)) statics_->set_gravity(pose.linear().transpose() * gravity_, reporting_to(report));
    place(pose);
    accept_displacement(report);
  }
  /// Back to the scene and pose of construction. Strong guarantee.
  void reset() {
    SetupReport report = report_;
    statics_->set_conditions(scene_, scene_.gravity(), reporting_to(report));
    place(Eigen::Isometry3d::Identity());
    gravity_ = scene_.gravity();
    accept_displacement(report);
  }

  // TissueModel
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int> vertices) noexcept { return compliance_.require(vertices); }
  void foresee(std::span<const int> vertices) noexcept { compliance_.foresee(vertices); }
  auto compliance(int i, int j) const noexcept { return compliance_(i, j); }
  double compliance_bound(int j) const noexcept { return compliance_.bound(j); }
  std::uint64_t compliance_revision() const noexcept { return compliance_.revision(); }
  double compliance_floor() const noexcept { return compliance_floor_; }
  /// Frame of the contact surface in the world.
  const Eigen::Isometry3d& pose() const noexcept { return world_; }

 private:
  template <class GivenMesh>
  void prepare(const GivenMesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
               const SetupOptions& options) {
    const std::vector<M> by_region = materials_by_region(mesh, materials);
    limits_.advance("admission", 0.0);
    Admitted<E> admitted = [&] {
      const StageTimer timer(report_, "admission");
      // A mesh that lists its groups keeps all, so that later conditions may name any.
      if constexpr (ListsGroups<GivenMesh>)
        return admit<E>(mesh, options.admission);
      else
        return admit<E>(mesh, options.admission, scene.group_names());
    }();
    report_admission(admitted, report_);
    node_map_ = std::move(admitted.node_map);
    scene_ = scene.mapped(node_map_);
    origin_ = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
    for (Vector3& x : admitted.mesh.positions) x -= origin_;
    world_ = pose_ * Eigen::Translation3d(origin_);

    Body<E> body = make_body(std::move(admitted.mesh), by_region);
    report_locking<E>(body.elasticity, report_);

    auto boundary = extract_boundary<E>(body.mesh);
    const Touchable touchable = resolve_touchable(body.mesh, boundary, scene_);
    touchable_ = touchable.nodes;
    seen_ = resolve_seen(body.mesh, boundary, scene_);
    statics_ = std::make_unique<Statics<E, Solver>>(std::move(body), scene_, std::move(boundary), touchable_, limits_,
                                                    options.cache_file, report_);
    statics_->set_conditions(scene_, scene_.gravity(), reporting_to(report_));
    gravity_ = scene_.gravity();
    prepare_contact(touchable.triangles, options);
  }

  void prepare_contact(const std::vector<Triangle>& triangles, const SetupOptions& options) {
    const StageTimer timer(report_, "compliance");
    const int vertices = static_cast<int>(touchable_.size());
    compliance_ =
        Compliance(statics_->system(), kept_index(), Traits::eager ? vertices : options.compliance_slots, limits_);
    if (Traits::eager)
      for (int v = 0; v < vertices; ++v) {
        if (v % 64 == 0) limits_.advance("compliance", static_cast<double>(v) / static_cast<double>(vertices));
        require_columns({&v, 1});
      }
    else if (vertices > 0)
      sample_columns(options.columns);
    // A thousandth of a millionth of the tissue's own compliance, or a nanometre per newton where nothing moves.
    for (int v = 0; v < vertices; ++v) compliance_floor_ = std::max(compliance_floor_, 1e-9 * compliance_.bound(v));
    if (compliance_floor_ == 0.0) compliance_floor_ = 1e-9;
    std::vector<Vector3> positions;
    for (NodeId node : touchable_) positions.push_back(deformed(node));
    surface_ = ContactSurface(positions, triangles);
    moved_ = std::move(positions);
    if (const int edges = surface_.crowded_edges())
      report_.set(SetupFlag::non_manifold, "more than two touchable triangles meet at " + std::to_string(edges) +
                                               " edges: contact does not pass across them smoothly");
    report_.touchable_vertices = vertices;
    report_.seen_nodes = static_cast<Index>(seen_.size());
    report_.compliance_bytes = compliance_.bytes();
    limits_.advance("checks", 1.0);
  }

  /// Kept dof of every touchable dof, -1 when it is prescribed.
  std::vector<Index> kept_index() const {
    std::vector<Index> index(3 * touchable_.size(), -1);
    Index kept = 0;
    for (std::size_t i = 0; i < index.size(); ++i)
      if (!statics_->conditions().is_constrained(3 * Index{touchable_[i / 3]} + static_cast<Index>(i % 3)))
        index[i] = kept++;
    return index;
  }

  /// Computes a few columns: how soft the surface is, and how long a column takes.
  void sample_columns(ColumnFill fill) {
    const int vertices = static_cast<int>(touchable_.size());
    const std::array sampled{0, vertices / 2, vertices - 1};
    const auto start = std::chrono::steady_clock::now();
    require_columns(sampled);
    report_.column_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 3.0;
    double softest = 0.0;
    for (int v : sampled) softest = std::max(softest, compliance_.bound(v));
    compliance_.assume(softest / std::sqrt(3.0));
    if (fill == ColumnFill::ahead) compliance_.fill_ahead();
  }

  Vector3 deformed(NodeId node) const noexcept {
    return mesh().position(node) + displacement().template segment<3>(3 * Index{node});
  }
  /// For changes of the loads: what is to be said of their displacement is said before they are accepted.
  auto reporting_to(SetupReport& report) const {
    return [this, &report](const VectorX& u) { report_displacement(statics_->body().mesh.positions, u, report); };
  }
  void accept_displacement(SetupReport& report) noexcept {
    std::swap(report_, report);
    move_surface();
  }
  void place(const Eigen::Isometry3d& pose) noexcept {
    pose_ = pose;
    world_ = pose_ * Eigen::Translation3d(origin_);
  }
  void move_surface() noexcept {
    for (std::size_t v = 0; v < touchable_.size(); ++v) moved_[v] = deformed(touchable_[v]);
    surface_.move_to(moved_);
  }

  SetupLimits limits_;
  SetupReport report_;
  Scene scene_;
  std::vector<NodeId> node_map_, touchable_, seen_;
  Vector3 origin_ = Vector3::Zero(), gravity_ = Vector3::Zero();
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity(), world_ = Eigen::Isometry3d::Identity();
  std::unique_ptr<Statics<E, Solver>> statics_;
  using Compliance = ContactCompliance<typename Statics<E, Solver>::System, typename Traits::Scalar>;
  Compliance compliance_;
  double compliance_floor_ = 0.0;
  ContactSurface surface_;
  std::vector<Vector3> moved_;
};

}}  // namespace palpate
