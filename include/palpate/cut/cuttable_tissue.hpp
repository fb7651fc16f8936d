// Linear tissue that can be touched while it is cut; independent of material and solver.
#pragma once

#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/cut_parameters.hpp>
#include <palpate/cut/detail/cut_preparation.hpp>
#include <palpate/cut/detail/cut_process.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/model/detail/admitted_mesh.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/model_base.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A linear body of elements E under cuts. Base of HapticFEModel on Cuttable<...>. `cut` orders a cut; `process_cuts`
/// applies the orders, in a thread of the caller's choice (BackgroundWorker); a tick begins with the newest state and
/// never waits. Directly after a cut the compliance is the old one plus a low-rank correction that the tick adds; then
/// the correction is folded in. While an order is open, ticks report degraded_model, and also stalled_tissue when
/// nobody has called process_cuts for 500 ticks, or a BackgroundWorker has failed. Vertex numbers never change, so
/// contact forces continue across a cut; the force gate limits their rate of change.
///
/// Threads: `begin_tick`, the functions of TissueModel and `try_cut` belong to the thread that ticks; all others may be
/// called from any thread and wait for each other, not for the tick. set_pose and reset must not run during a tick.
/// Neither copied nor moved. Satisfies TissueModel; one session at a time.
template <Element E>
class CuttableTissue : public ModelBase {
  static_assert(!detail::HasSmoothedStrain<E>,
                "palpate: a cut changes the averages of smoothed elements far from it: choose Tet4 or Tet10");

 public:
  using Parameters = CutParameters;

  // Any thread

  /// Orders a cut. Immediately throws index_out_of_range for invalid ids.
  void cut(CutOrder order) {
    detail::require_ids<E>(order, elements_.load(std::memory_order_acquire));
    orders_.add(std::move(order));
  }
  /// Orders a cut along the sheet swept by a blade, in the world's frame, through the body deformed by its loads,
  /// and, in TouchingTissues, by the other tissues and the tools.
  void cut(const BladeSweep& sweep) { orders_.add(sweep); }

  /// Applies all orders as one cut, publishes the new compliance, then folds the update in. Without orders, runs one of
  /// the deferred checks: error, bounds, nodes inside. True when there was something to do. Throws std::bad_alloc when
  /// memory is short: the body is then that before the orders, which are dropped, or, when its new compliance was
  /// complete, that after them, which the next call publishes.
  bool process_cuts() {
    const detail::CutServed::Call call(served_);  // also while it waits for a change of the loads
    const std::scoped_lock lock(changes_);
    const ScopedIdTranslation translation(original_ids());
    detail::CutOrders::Taken taken = orders_.take();
    const auto is_gone = [count = elements_.load(std::memory_order_acquire)](Index e) { return e >= count; };
    std::erase_if(taken.order.remove, is_gone);  // given before a reset
    std::erase_if(taken.order.open, [&](const detail::ElementFace& f) { return is_gone(f.element); });
    struct Done {
      CuttableTissue& tissue;
      const detail::CutOrders::Taken& taken;
      ~Done() {
        tissue.failed_.store(tissue.process_->report().failed, std::memory_order_release);
        tissue.elements_.store(tissue.process_->topology().mesh().element_count(), std::memory_order_release);
        if (taken.count > 0) tissue.orders_.done(taken);
      }
    } const done{*this, taken};
    return process_->process(taken, inverse(to_world()));
  }
  /// The same for BackgroundWorker: checks for orders every 0.2 ms.
  BackgroundStep background_work() {
    const bool worked = process_cuts();
    return {worked, worked ? 0.0 : 2e-4};
  }
  CutReport cut_report() const {
    const std::scoped_lock lock(changes_);
    return process_->report();
  }
  /// Visits topology and physics; no cut is applied meanwhile.
  template <class Visit>
  void read(Visit&& visit) const {
    const std::scoped_lock lock(changes_);
    visit(process_->topology(), process_->physics());
  }

  /// Displacement of all nodes, including those created by cuts, with forces on vertices (of the current surface or an
  /// earlier one), 3 per node [m]. Detached fragments keep their displacement before the cut that detached them, or
  /// return to their place in the body at rest, where it was too large for linear elasticity. Throws
  /// index_out_of_range for a vertex that does not exist, non_finite for a force that is not finite. O(kept x forces)
  /// and two substitutions.
  VectorX displacement(std::span<const VertexForce> forces = {}) {
    const std::scoped_lock lock(changes_);
    return process_->displacement_with(forces);
  }
  /// The same into u, which is resized. Allocates. Not converged, with u unchanged, where `displacement` would throw.
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept {
    if (detail::attempt([&] { u = displacement(forces); })) return {true, 0, 0.0};
    return {false, 0, infinity};
  }

  /// Replaces loads and prescribed values. Throws as LinearTissue::set_conditions. Makes a new factor. Strong
  /// guarantee.
  void set_conditions(const Scene& scene) {
    const std::scoped_lock lock(changes_);
    const ScopedIdTranslation translation(original_ids());
    Scene changed = this->mapped(scene, triangles_);
    elastic_body().conditions(changed).require_components(elastic_body().conditions(loaded_));
    std::string others = changed.loads_in_words();
    process_->set_loads(detail::boundary_of<E>(elastic_body()), changed.gravity(local(scene.gravity(), pose())));
    loaded_ = std::move(changed);
    keep_loads(scene.gravity(), others);
  }
  /// Gravity [m/s^2] in the world's frame. Makes a new factor. Strong guarantee.
  void set_gravity(const Vector3& gravity) {
    require_finite_gravity(gravity);
    const std::scoped_lock lock(changes_);
    load_by(gravity, pose());
    keep_gravity(gravity);
  }
  /// Pose of the organ in the world; rotates gravity with it, which makes a new factor. Not during a tick. Throws
  /// bad_argument unless it is a rigid motion. Strong guarantee.
  void set_pose(const Eigen::Isometry3d& pose) {
    require_rigid(pose);
    const std::scoped_lock lock(changes_);
    if (!gravity().isZero(0.0)) load_by(gravity(), pose);
    place(pose);
  }
  /// Restores the uncut body with scene and pose of construction; drops waiting orders and the vertices that cuts have
  /// created. Makes a new factor. Not during a tick. Strong guarantee.
  void reset() {
    const std::scoped_lock lock(changes_);
    std::string others = scene().loads_in_words();
    process_->reset(detail::boundary_of<E>(elastic_body()), scene());
    if (const detail::CutOrders::Taken taken = orders_.take(); taken.count > 0) orders_.done(taken);
    failed_.store(false, std::memory_order_release);
    elements_.store(process_->topology().mesh().element_count(), std::memory_order_release);
    loaded_ = scene();
    place(Eigen::Isometry3d::Identity());
    keep_loads(scene().gravity(), others);
  }

  // The thread that cuts, between two calls of background_work: for contact with other tissues (TouchingTissues)

  /// Forces of other tissues and of tools on the surface: blades cut the body as they displace it.
  void set_contact_forces(std::span<const VertexForce> forces) {
    const std::scoped_lock lock(changes_);
    process_->set_contact_forces(forces);
  }
  /// The surface after the last cut, the number of such changes, a contact problem on it for a session to continue
  /// with, and the compliance. Valid until the next one.
  const ContactSurface& newest_surface() const noexcept { return newest_->contact->surface; }
  std::uint64_t newest_surface_number() const noexcept { return newest_->contact->cut; }
  std::shared_ptr<ContactProblem> newest_contact() const noexcept {
    return {newest_->contact, &newest_->contact->problem};
  }
  Matrix3 newest_compliance(int i, int j) const noexcept { return newest_->compliance(i, j); }

  // The thread that ticks

  /// Orders a cut from a tick; returns false when too many are waiting. Never waits.
  bool try_cut(const BladeSweep& sweep) noexcept { return orders_.try_add(sweep); }
  Status begin_tick() noexcept {
    Status status = order_status();
    if (views_.update() && contact().cut != revision_) {  // folding changes nothing that a session stores
      renewed_ = true;
      revision_ = contact().cut;
    }
    if (contact().left_out) status.set(StatusFlag::degraded_model);
    if (contact().too_far) status.set(StatusFlag::large_displacement);
    return status;
  }
  bool has_orders() const noexcept { return orders_.are_open(); }
  /// Once per tick: degraded_model while an order is open, or after a cut has failed; stalled_tissue where nobody makes
  /// cuts.
  Status order_status() noexcept {
    Status status;
    const bool are_open = orders_.are_open();
    if (are_open || failed_.load(std::memory_order_acquire)) status.set(StatusFlag::degraded_model);
    if (served_.is_stalled(are_open)) status.set(StatusFlag::stalled_tissue);
    return status;
  }
  /// Moves a session's contact to a new surface.
  void exchange_contacts(ContactProblem& problem) noexcept {
    if (std::exchange(renewed_, false)) problem.move_to(contact().problem, contact().surface);
  }
  /// Makes the contact surface for the tools of a session that begins; not while another session ticks. Throws
  /// bad_argument when a tool is too small for the mesh. Strong guarantee.
  void prepare_tools(const ToolRadii& radii, const ContactParameters& contact) {
    const std::scoped_lock lock(changes_);
    process_->set_tools(radii, contact, detail::loads_in_words(gravity(), other_loads()));
    views_.update();
    revision_ = view().contact->cut;
    renewed_ = false;
  }
  const ContactSurface& contact_surface() const noexcept { return contact().surface; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return view().compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return revision_; }
  double compliance_bound(int j) const noexcept { return view().bound[static_cast<std::size_t>(j)]; }
  double compliance_floor() const noexcept { return view().floor; }
  NoHook prefetch(std::span<const int>) noexcept { return {}; }
  NoHook end_tick(std::span<const VertexForce>, std::span<const PointForce>) noexcept { return {}; }
  NoHook half_space_map(int) const noexcept { return {}; }
  NoHook updates() const noexcept { return {}; }
  NoHook report_slow(bool) noexcept { return {}; }
  void report_failed(bool failed) noexcept { served_.report_failed(failed); }
  /// One servo at a time: a cut moves its contacts to the new surface.
  TissueClaim& claim() noexcept { return claim_; }

 protected:
  /// Throws as admission, assembly and factorisation; unconstrained when a part is not constrained, unsupported for a
  /// cache file.
  template <MeshOf<E> Given, class M>
  CuttableTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                 const SetupOptions& options, const CutParameters& parameters)
      : ModelBase(options) {
    static_assert(LinearMaterial<M>, "palpate: tissue that is cut needs a LinearMaterial, for example LinearElastic");
    if (!options.cache_file.empty())
      raise(SetupErrorKind::unsupported, "a cache file for tissue that is cut",
            "Leave cache_file empty; a cache file does not store cuts");
    set_up(scene, detail::admit_body<E>(mesh, scene, materials, options.admission, limits(), setup_report()),
           parameters);
  }

 private:
  /// The set-up after admission. Throws as prepare_cut and CutProcess.
  void set_up(const Scene& scene, detail::AdmittedBody admitted, const CutParameters& parameters) {
    triangles_ = admit(scene, std::move(admitted)).triangles;
    const ScopedIdTranslation translation(original_ids());
    elastic_body().report_locking(setup_report());
    const Body<E>& body = detail::body_of<E>(elastic_body());
    elements_.store(body.mesh.element_count(), std::memory_order_release);
    loaded_ = this->scene();
    std::optional<Selection> cuttable;
    if (parameters.cuttable) cuttable = palpate::mapped(*parameters.cuttable, node_map(), origin());
    process_ = std::make_unique<detail::CutProcess<E>>(
        detail::prepare_cut(body, detail::boundary_of<E>(elastic_body()), this->scene(), cuttable, original_ids()),
        parameters, limits(),
        [this](detail::CutView&& made) {
          views_.back() = std::move(made);  // frees views that no tick can access any more
          newest_ = &views_.back();
          views_.publish();
        },
        setup_report());
    views_.update();
    setup_report().kept_dofs = process_->report().kept;
    setup_report().free_dofs = elastic_body().conditions(this->scene()).free_count();
    setup_report().condensed_dofs = setup_report().free_dofs - setup_report().kept_dofs;
    detail::report_displacement(elastic_body().positions(),
                                process_->displacement_with({}).head(3 * body.mesh.node_count()), setup_report());
  }

  void load_by(const Vector3& gravity, const Eigen::Isometry3d& pose) {
    const ScopedIdTranslation translation(original_ids());
    Scene changed = loaded_;
    process_->set_loads(detail::boundary_of<E>(elastic_body()), changed.gravity(local(gravity, pose)));
  }
  const detail::CutView& view() const noexcept { return views_.front(); }
  detail::CutContact& contact() const noexcept { return *view().contact; }

  std::vector<Triangle> triangles_;  // touchable before any cut
  Scene loaded_;                     // the last scene set; its gravity is not used
  std::atomic<Index> elements_{0};
  mutable std::mutex changes_;
  detail::CutOrders orders_;
  detail::CutServed served_;
  TissueClaim claim_;
  std::atomic<bool> failed_{false};
  TripleBuffer<detail::CutView> views_;
  const detail::CutView* newest_ = nullptr;  // published last: not written before the next one is
  std::uint64_t revision_ = 0;               // the last one seen by a tick
  bool renewed_ = false;
  std::unique_ptr<detail::CutProcess<E>> process_;
};

}}  // namespace palpate
