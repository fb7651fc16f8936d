// Linear static tissue independent of element, material and solver: the interface of a static HapticFEModel for
// sessions and programs.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/model_base.hpp>
#include <palpate/model/static/detail/contact_compliance.hpp>

#include <Eigen/Geometry>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

class AnyStiffness;

}  // namespace detail
class Statics;
namespace detail {

struct SolverRecipe;

}  // namespace detail

/// The part of HapticFEModel that does not depend on element, material or solver. Scalar, float or double, is the type
/// of the stored compliance. Base of the static HapticFEModel. Satisfies TissueModel.
template <std::floating_point Scalar>
class LinearTissue : public ModelBase, public StillTissue {
 public:
  /// Displacement under the loads of the scene without tools, 3 per admitted node [m].
  const VectorX& displacement() const noexcept;
  /// Internal force K u - f_0, 3 per admitted node [N].
  VectorX internal_force() const;
  /// Reaction forces of the supports, zero on free dofs, 3 per admitted node [N].
  VectorX reactions() const;
  double strain_energy() const;

  /// Displacement with these forces on the contact surface, for drawing: one back-substitution. u has 3 entries per
  /// admitted node [m]. Allocates only to resize u when it has another size. A force on a vertex that does not exist is
  /// ignored, and the report states not converged. May run during a tick, but not in two threads simultaneously.
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept;
  /// The same as a new vector; allocates. Throws index_out_of_range for a vertex that does not exist, non_finite for a
  /// force that is not finite, not_converged for a solve that stopped early.
  VectorX displacement(std::span<const VertexForce> forces);

  /// Replaces loads and prescribed values. Throws unsupported when the set of prescribed components, or the touchable
  /// nodes or faces, differ from those of the construction. A scene without touch() keeps the touchable set; render()
  /// is ignored. Strong guarantee.
  void set_conditions(const Scene& scene);
  /// Sets gravity [m/s^2] in the world frame. Strong guarantee.
  void set_gravity(const Vector3& gravity);
  /// Sets the pose of the organ in the world; the direction of gravity in the body changes with it. Throws bad_argument
  /// unless it is a rigid motion. Strong guarantee.
  void set_pose(const Eigen::Isometry3d& pose);
  /// Restores the scene and pose of construction. Strong guarantee.
  void reset();

  // TissueModel
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int> vertices) noexcept { return compliance_.require(vertices); }
  void prefetch(std::span<const int> vertices) noexcept { compliance_.prefetch(vertices); }
  auto compliance(int i, int j) const noexcept { return compliance_(i, j); }
  double compliance_bound(int j) const noexcept { return compliance_.bound(j); }
  std::uint64_t compliance_revision() const noexcept { return compliance_.revision(); }
  double compliance_floor() const noexcept { return compliance_floor_; }

 protected:
  using MakeStiffness = detail::AnyStiffness (*)(const ElasticBody&, const SetupLimits&);

  explicit LinearTissue(const SetupOptions& options);
  LinearTissue(LinearTissue&&) noexcept;
  LinearTissue& operator=(LinearTissue&&) noexcept;
  ~LinearTissue();

  /// The part of the set-up after admission. Throws the errors of Statics and ContactCompliance.
  void set_up(const Scene& scene, detail::AdmittedBody admitted, MakeStiffness make_stiffness,
              const detail::SolverRecipe& recipe, const SetupOptions& options);

 private:
  void prepare_contact(const detail::Touchable& touchable, bool eager, const SetupOptions& options);
  /// Measures the error of forces on the tool that the scene names. What makes it impossible is reported only.
  void measure_force_error(const ForceErrorOptions& options);
  /// Errors of the forces that do not come from the mesh.
  detail::LinearModelError model_error() const;
  /// Kept dof of every touchable dof, -1 when it is prescribed.
  std::vector<Index> kept_index() const;
  /// Computes a few columns to measure the compliance of the surface and the time per column; decides whether a
  /// background thread is to compute the others.
  void sample_columns(ColumnFill fill);
  /// Whether the three solves for a vertex would delay a tick.
  bool is_column_late() const;
  Vector3 deformed(NodeId node) const noexcept;
  /// For changes of the loads: a function that enters the findings on a new displacement in `report` before it is
  /// accepted.
  std::function<void(const VectorX&)> reporting_to(SetupReport& report) const;
  void accept_displacement(SetupReport& report) noexcept;
  void move_surface() noexcept;

  std::unique_ptr<Statics> statics_;
  detail::ContactCompliance<Scalar> compliance_;
  double compliance_floor_ = 0.0;
  ContactSurface surface_;
  std::vector<Vector3> moved_;
  std::vector<NodeId> shell_nodes_;  // of the boundary that cannot be touched
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/linear_tissue.ipp>
#endif
