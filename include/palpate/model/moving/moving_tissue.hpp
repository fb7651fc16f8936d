// Moving tissue independent of element, material and motion: the interface for sessions and programs.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/detail/near_compliance.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/model/model_base.hpp>
#include <palpate/model/moving/detail/contact_springs.hpp>
#include <palpate/model/moving/detail/force_agreement.hpp>
#include <palpate/model/moving/detail/secant_compliance.hpp>
#include <palpate/model/moving/detail/split_vertices.hpp>
#include <palpate/model/moving/detail/surface_stretch.hpp>
#include <palpate/model/moving/detail/vertex_compliance.hpp>
#include <palpate/model/moving/tissue_motion.hpp>
#include <palpate/model/detail/nodal_rotation.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

struct BlockPattern;

}  // namespace detail

/// A body that moves at its own rate, in a background thread of a servo that solves the contact in every tick (the
/// architecture of Duriez et al. 2006 and Courtecuisse et al. 2015). Base of HapticFEModel on Implicit<...> and
/// Explicit<...>.
///
/// After every step the tissue publishes the position of its surface without the tool forces, and the rotation of each
/// vertex. Between two steps the servo solves the contact on that surface with the compliance of one step from the
/// settled state, rotated with the vertices: C_ij = R_i C0_ij R_j^T (compliance warping, Saupin et al. 2008). The
/// forces at the end of a step correct that step and act in the next one: as springs between tools and contact points
/// (ContactSprings), or as loads where the motion has no springs. For a motion without inertia C is also scaled and
/// corrected by the last steps (SecantCompliance), so that it follows the state. In a steady contact the force is that
/// of the non-linear equilibrium, for any step length and for an inexact C: C only predicts the change until the next
/// step.
///
/// Threads: `advance` and the functions that change the model may run in any thread except the ticking one, and lock
/// each other out. The functions of TissueModel are for the ticking thread, `displacement_with` for one drawing thread;
/// neither ever waits. set_pose and reset must not run during a tick. Neither copyable nor movable. Satisfies
/// TissueModel.
class MovingTissue : public ModelBase {
 public:
  /// Maximum number of vertex forces, three per contact; forces beyond it are not applied.
  static constexpr std::size_t most_forces = 3 * largest_default_capacity;
  /// Maximum number of contact points.
  static constexpr std::size_t most_points = largest_default_capacity;
  /// Maximum number of vertices around the tools, and of those that press, whose compliance is evaluated by the thread
  /// that steps. Ticks evaluate the others.
  static constexpr std::size_t most_near = 512, most_pressed = 192;

  // The thread that steps (BackgroundWorker)

  /// Corrects the last step for the current tool forces, then advances by one step. No allocation; the duration is that
  /// of the step.
  MotionStep advance() noexcept;
  /// One step, for BackgroundWorker.
  BackgroundStep background_work() noexcept {
    advance();
    return {true, step_};
  }
  /// Step length of the motion [s].
  double step() const noexcept { return step_; }
  /// Steps published so far.
  std::uint64_t steps() const noexcept { return steps_; }
  /// Reports whether steps take longer to compute than their length, so that the tissue moves in slow motion; sets
  /// slow_tissue in ticks.
  void report_slow(bool slow) noexcept { slow_.store(slow, std::memory_order_relaxed); }
  /// Reports whether a BackgroundWorker has stopped because a step threw; sets stalled_tissue in ticks until the next
  /// step.
  void report_failed(bool failed) noexcept { failed_work_.store(failed, std::memory_order_relaxed); }
  /// The motion; for the stepping thread.
  const TissueMotion& motion() const noexcept { return *motion_; }

  // The thread that steps, between two steps: for contact with other tissues (TouchingTissues)

  /// Forces of other tissues on the surface, one per vertex, which act from the next step on besides those of tools,
  /// without friction. Together with the tools' at most most_points, else all are loads (degraded_model). Allocates
  /// where there are more than before.
  void set_contact_forces(std::span<const VertexForce> forces);
  /// The surface after the last step without the forces on it, and its compliance. Valid until the next step.
  const ContactSurface& newest_surface() const noexcept { return newest().surface; }
  Matrix3 newest_compliance(int i, int j) const noexcept { return evaluate(newest(), i, j); }

  // Any thread but the one that ticks

  /// Replaces loads and prescribed values from the next step on. Throws as LinearTissue::set_conditions. Strong
  /// guarantee.
  void set_conditions(const Scene& scene);
  /// Sets gravity [m/s^2] in the world frame from the next step on. Strong guarantee.
  void set_gravity(const Vector3& gravity);
  /// Sets the pose of the organ in the world; the direction of gravity in the body changes with it. No inertial forces
  /// of the moving frame are applied. Not during a tick. Throws bad_argument unless it is a rigid motion. Strong
  /// guarantee.
  void set_pose(const Eigen::Isometry3d& pose);
  /// Restores scene, pose and state of construction. Not during a tick. Strong guarantee.
  void reset();

  // One thread that draws

  /// Displacement after the newest step, 3 per admitted node [m]; it includes the effect of the tool forces. Resizes u
  /// when it has another size. A copy, and half a solve with linear surroundings. Never waits.
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept;
  /// The same as a new vector.
  VectorX displacement(std::span<const VertexForce> forces = {});

  // TissueModel: the thread that ticks

  /// Takes the newest surface. Status: `inverted` while elements are inverted; `material_exceeded` while some are
  /// beyond the range of their material; solver_not_converged when the last step
  /// ended far from its solution, or when it and ticks find different forces; degraded_model when a step could not
  /// be corrected for the tool forces, so that only the next one includes them, or when there were more than
  /// most_forces; non_finite_force when the last `end_tick` received forces that are not finite; slow_tissue when a
  /// BackgroundWorker does not keep up, stalled_tissue when it has failed; large_displacement when linear surroundings
  /// are displaced too far.
  Status begin_tick() noexcept;
  /// Forces that are not finite are ignored. Forces without points are dead loads of the steps.
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points = {}) noexcept;
  const ContactSurface& contact_surface() const noexcept { return views_.front().surface; }
  /// The next surface comes with the compliance of these vertices, for those whose displacement is requested until
  /// then.
  Status require_columns(std::span<const int> vertices) noexcept;
  Matrix3 compliance(int i, int j) const noexcept {
    const View& view = views_.front();
    list(i, revision_, view.requested, near_);
    const Matrix3* ready = view.near_compliance.find(i, j);
    return ready != nullptr ? *ready : evaluate(view, i, j);
  }
  /// Displacement of a vertex under forces [m]: with `compliance`, but several times as fast.
  Vector3 displacement_of(int i, std::span<const VertexForce> forces) const noexcept;
  std::uint64_t compliance_revision() const noexcept { return revision_; }
  /// Number of surfaces taken so far.
  std::uint64_t updates() const noexcept { return revision_; }
  double compliance_bound(int j) const noexcept {
    return views_.front().compliance.bound(j) + views_.front().secants.bound(static_cast<std::size_t>(j));
  }
  double compliance_floor() const noexcept { return views_.front().compliance.floor(); }
  Matrix3 half_space_map(int v) const noexcept { return views_.front().half_space[static_cast<std::size_t>(v)]; }
  NoHook prefetch(std::span<const int>) noexcept { return {}; }
  NoHook exchange_contacts(ContactProblem&) noexcept { return {}; }
  /// Takes the newest surface, and updates the description of loads that error messages contain; not while a session
  /// ticks.
  void prepare_tools(const ToolRadii&, const ContactParameters&);
  NoHook try_cut(const BladeSweep&) noexcept { return {}; }
  /// One servo at a time: its forces load the next step.
  TissueClaim& claim() noexcept { return claim_; }

 protected:
  explicit MovingTissue(const SetupOptions& options);
  virtual ~MovingTissue();

  /// A body of some materials, and what of it can be touched.
  template <class MaterialBody>
  struct AdmittedMaterials {
    MaterialBody body;
    detail::Touchable touchable;
  };
  /// Admits a mesh and evaluates its materials. Throws the errors of admission, bad_argument for a step that is not
  /// positive, unconstrained for a body that can move where `parameters` ask for an equilibrium. Definition:
  /// model/moving/moving_model.hpp.
  template <Element E, class Given, class M, class Parameters>
  auto admit_materials(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                       const SetupOptions& options, const Parameters& parameters);
  /// The part of the set-up after the motion is prepared. Solves once per touchable dof. Throws not_converged and the
  /// errors of WarpedCompliance.
  void set_up(const detail::Touchable& touchable, PreparedMotion prepared, double step,
              const detail::BlockPattern& pattern);

  // For tissue whose body is cut

  /// A surface after a cut. Vertices keep their numbers; new ones follow.
  struct CutVertices {
    std::vector<NodeId> nodes;  ///< of every vertex
    std::vector<int> similar;   ///< per vertex the vertex of the set-up whose compliance it has
    std::vector<double> side;   ///< per vertex, of a slit: 1 on one lip, -1 on the other one, 0 far away
    std::vector<int> parent;    ///< per vertex the vertex whose node its node was split from, -1 without one
    ContactSurface surface;
    std::shared_ptr<ContactProblem> contact;  ///< for a session to continue with
    Status status;                            ///< of ticks on this surface, in addition to those of the steps
  };
  /// Called by `advance` before every step, with the changes locked out. False: no step can be made.
  virtual bool prepare_step() noexcept { return true; }
  /// Loads of a scene of the admitted mesh on the present body, without gravity, 3 per node [N]. Throws as the loads
  /// of a scene.
  virtual VectorX applied_load(const Scene& scene) const;
  /// Continues on another surface of the motion's body, which has changed; `mass` per node, `pattern` and `positions`
  /// of all its nodes. Loads become those of the scene on this body. From `prepare_step`. Allocates.
  void change_surface(CutVertices surface, const VectorX& mass, const detail::BlockPattern& pattern,
                      const std::vector<Vector3>& positions);
  /// Rests at the start under the loads of the set-up; for its body.
  void rest_at_start();
  /// Loads the scene's conditions and rests at the start, for the body of the set-up.
  void restart();
  std::mutex& changes() noexcept { return changes_; }
  /// Publishes the present state for ticks and drawing.
  void publish(Status status) noexcept;
  /// Takes the newest surface; for the thread that ticks.
  void take_surface() noexcept;
  /// Of the surface that a tick uses: number of changes before it, and its contact problem.
  std::uint64_t surface_number() const noexcept { return views_.front().number; }
  ContactProblem* surface_contact() const noexcept { return views_.front().contact.get(); }

 private:
  template <std::size_t Most>
  struct VertexList {
    std::array<int, Most> item{};
    std::size_t count = 0;
    std::span<const int> all() const noexcept { return {item.data(), count}; }
  };
  struct View;
  struct Forces {
    std::array<VertexForce, most_forces> item{};
    std::size_t count = 0;
    std::array<PointForce, most_points> point{};
    std::size_t points = 0;
    const View* view = nullptr;           // of the tick; the thread that steps may read it in its next step
    VertexList<most_pressed> pressed;     // of the rows since the last surface, also of those without force
    VertexList<most_near> near_vertices;  // whose displacement was requested
    std::uint64_t number = 0;             // of the surface of the tick
  };
  struct View {
    std::vector<Vector3> free, pressed;         // positions without and with the forces used_
    std::vector<Matrix3> rotation, half_space;  // how it turns and stretches the surface: SurfaceStretch
    detail::SecantTerms secants;
    detail::NearCompliance near_compliance;
    ContactSurface surface;
    Status status;
    detail::VertexCompliance compliance;
    mutable std::vector<std::uint64_t> requested;  // per vertex: the last surface for which it was requested
    std::vector<std::uint64_t> required;           // the same for those required
    std::uint64_t number = 0;                      // of the surface: changes before it
    std::shared_ptr<ContactProblem> contact;
  };
  /// Of the last step; before the first one that of the set-up.
  const View& newest() const noexcept { return newest_ != nullptr ? *newest_ : views_.front(); }
  /// The forces of the last tick and of other tissues.
  const Forces& given() const noexcept { return others_ ? others_->all : pressing_.front(); }
  void add_others() noexcept;

  /// A view of all vertices, without surface, data of a step and room for the compliance near the contacts.
  View make_view() const;

  static std::size_t vertex(int v) noexcept { return static_cast<std::size_t>(v); }
  static std::size_t vertex(const VertexForce& f) noexcept { return vertex(f.vertex); }
  /// Loads of a scene of the admitted mesh [N]; `gravity` in the body's frame.
  VectorX load_of(const Scene& scene, const Vector3& gravity) const;
  void add(const Forces& forces, double factor, VectorX& load) const noexcept;
  /// Position of the surface without the current tool forces, computed with the compliance of the servo, so that the
  /// same forces restore the current position.
  void update_view(View& view) noexcept;
  /// Scales the compliance by what the last step has found.
  void follow_stiffness(const std::vector<Matrix3>& rotation) noexcept;
  /// Compliance that the last step has found, relative to that of the ticks; 1 when it has found none.
  double found_compliance(const std::vector<Matrix3>& rotation) noexcept;
  /// The same from the response of the last step to its forces, less what the springs bear of them. O(forces^2).
  double response_ratio(const std::vector<Matrix3>& rotation) noexcept;
  /// Sets springs for forces of a tick, or none.
  void compare_forces(const std::vector<Matrix3>& rotation) noexcept;
  void set_springs(const Forces& forces) noexcept;
  /// Compliance of two vertices, rotated and corrected by the last steps [m/N].
  Matrix3 evaluate(const View& view, int i, int j) const noexcept;
  /// Appends a vertex unless it was listed in the same `round`, or there is no room.
  template <std::size_t Most>
  static void list(int v, std::uint64_t round, std::vector<std::uint64_t>& listed, VertexList<Most>& into) noexcept {
    if (listed[vertex(v)] == round || into.count == Most) return;
    listed[vertex(v)] = round;
    into.item[into.count++] = v;
  }
  /// Takes the newest forces of a tick; whether there are new ones. One before a reset may name vertices of cuts that
  /// the reset has dropped.
  bool take_forces() noexcept;
  void drop_gone() noexcept;
  void start_secants();
  void list_every_vertex();
  std::span<const int> near_vertices() const noexcept;
  bool presses_beside_slit() const noexcept;
  void record_pair(const Forces& before, double error) noexcept;
  void record_response(Forces& part, const MotionStep& done) noexcept;
  /// The displacement of the vertices.
  void find_moved(std::vector<Vector3>& moved) const noexcept;

  double step_ = 0.0;
  std::unique_ptr<TissueMotion> motion_;
  bool accepts_initial_strains_ = false;
  detail::NodalRotations rotations_;
  VectorX start_, start_load_, start_prescribed_;
  VectorX mass_;            // per node [kg]
  Scene loaded_;            // the last scene set; its gravity is not used
  VectorX applied_, load_;  // of that scene without and with gravity [N]
  VectorX full_;
  VectorX response_;  // of the last step to forces
  detail::VertexCompliance compliance_;
  detail::SecantCompliance secants_;
  bool found_stiffness_ = false;               // a pair of the last step
  std::vector<NodeId> nodes_;                  // of every vertex
  std::vector<int> every_;                     // vertex
  std::vector<Vector3> rest_;                  // of every vertex, without loads [m]
  View changed_;                               // of the newest surface, when it has changed
  std::vector<Vector3> moved_, moved_before_;  // of the vertices, after the last step and the one before
  bool loads_changed_ = false;                 // since the last step: displacements then changed for other reasons
  bool was_slit_ = false;                      // since the last step
  detail::SplitVertices split_;                // of the last change of the surface
  Forces used_;
  detail::ForceAgreement agreement_;
  detail::ContactSprings springs_;  // of the newest forces; without them these are loads
  bool has_springs_ = false;        // in the last step
  bool takes_springs_ = false;      // whether the motion does
  bool has_friction_ = false;       // of the servo's contacts
  detail::SurfaceStretch stretch_;
  bool stretches_ = false;
  std::uint64_t steps_ = 0;
  std::mutex changes_;
  std::atomic<bool> slow_{false}, failed_work_{false};
  TissueClaim claim_;
  TripleBuffer<View> views_;
  const View* newest_ = nullptr;  // published last: not written before the step after the next one
  TripleBuffer<VectorX> drawn_;
  TripleBuffer<Forces> pressing_;
  struct OtherForces {
    std::vector<VertexForce> item;          // of other tissues
    bool changed = true, left_out = false;  // left out: forces, or their springs
    Forces all;                             // with those of the last tick
  };
  std::unique_ptr<OtherForces> others_;  // null while no other tissue has touched this one
  std::vector<Triangle> triangles_;      // of the surface
  std::uint64_t views_made_ = 0;
  std::uint64_t revision_ = 0;
  Status ticked_;                     // of the last end_tick
  VertexList<most_pressed> pressed_;  // since the surface was taken, as the next
  mutable VertexList<most_near> near_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/moving_tissue.ipp>
#endif
