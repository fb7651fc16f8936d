// A linear tissue that can be touched while it is cut.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/contact_samples.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/blade_sweep.hpp>
#include <palpate/cut/cut_orders.hpp>
#include <palpate/cut/cut_physics.hpp>
#include <palpate/cut/cut_preparation.hpp>
#include <palpate/cut/cut_renewal.hpp>
#include <palpate/cut/cut_surface.hpp>
#include <palpate/cut/cut_system.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/cut_view.hpp>
#include <palpate/cut/cuttable_options.hpp>
#include <palpate/cut/topology_change.hpp>
#include <palpate/haptic/triple_buffer.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/touchable.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A linear body of elements E under cuts. `cut` orders; `work` does what is ordered, in a thread of the caller's
/// choice (CutThread); the tick brings the newest state in at its beginning and never waits. Right after a cut the
/// compliance is the old one with a correction of low rank, added up in the tick; then the correction is folded in.
/// While an order is open ticks say degraded_model. Numbers of vertices never change, so contact forces go on across a
/// cut; the force gate limits how fast they may change.
///
/// Threads: `begin_tick` and the functions of TissueModel belong to the thread that ticks, `stroke` too; all others may
/// be called from any thread and wait for each other, not for the tick. Satisfies TissueModel; one session at a time.
template <Element E>
class CuttableTissue {
 public:
  /// One material everywhere, or one per region. Throws what admission, assembly and factorisation throw; unconstrained
  /// when a part is not held.
  template <LinearMaterial M>
  CuttableTissue(const Mesh<E>& mesh, const Scene& scene, const M& material, const CuttableOptions& options = {})
      : CuttableTissue(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}
  template <LinearMaterial M>
  CuttableTissue(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                 const CuttableOptions& options = {})
      : CuttableTissue(prepare_cut(mesh, scene, materials, options), options) {}
  CuttableTissue(const CuttableTissue&) = delete;
  CuttableTissue& operator=(const CuttableTissue&) = delete;

  // Any thread

  /// Orders a cut. Throws index_out_of_range at once for ids outside.
  void cut(CutOrder order) {
    const auto outside = [&](Index e) { return e < 0 || e >= elements_; };
    for (const Index e : order.remove) require_element(!outside(e), e);
    for (const ElementFace& f : order.open)
      require_element(!outside(f.element) && f.face >= 0 && f.face < static_cast<int>(E::faces.size()), f.element);
    orders_.add(std::move(order));
  }
  /// Orders a cut along what a blade sweeps, in the world's frame, through the body as it is deformed by its loads.
  void cut(const BladeSweep& sweep) { orders_.add(sweep); }

  /// Does all that is ordered as one cut and makes it felt, then folds it in. When nothing is ordered, one of the
  /// things that nobody waits for: measuring the error, bounds, nodes inside. True when there was something to do.
  bool work() {
    const std::scoped_lock lock(system_mutex_);
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const bool renewed = take_renewal();
    const CutOrders::Taken taken = orders_.take();
    if (taken.count == 0) return check_next() || renewed;
    const TopologyChange<E> change = topology_.apply(order_of(taken));
    if (!change.empty()) {
      ++report_.cuts;
      touchable_.update(topology_, change);
      take_in(change);
      report_.felt_seconds = seconds();
      settle();
      report_.fold_seconds = seconds();
    }
    orders_.done(taken);
    return true;
  }
  CutReport report() const {
    const std::scoped_lock lock(system_mutex_);
    return report_;
  }
  /// Visits topology and physics while nothing is cut.
  template <class Visit>
  void read(Visit&& visit) const {
    const std::scoped_lock lock(system_mutex_);
    visit(topology_, physics_);
  }
  /// Displacement of all nodes with forces on vertices (those of the present surface or an earlier one), 3 per node
  /// [m]. Nodes of loose pieces rest where they were when they came off. Throws index_out_of_range for a vertex that
  /// does not exist, non_finite for a force that is not finite. O(kept x forces) and two substitutions.
  VectorX displacement_with(std::span<const VertexForce> forces) {
    const std::scoped_lock lock(system_mutex_);
    require_vertex_forces(forces, static_cast<int>(touchable_.nodes().size()));
    std::vector<std::pair<NodeId, Vector3>> list;
    for (const VertexForce& f : forces)
      list.push_back({touchable_.nodes()[static_cast<std::size_t>(f.vertex)], f.force});
    return system_.displacement_with(list);
  }
  /// Where the mesh's frame lies in that of the mesh as given [m].
  const Vector3& origin() const noexcept { return origin_; }

  // The thread that ticks

  /// Orders a cut from a tick; false when too many are waiting. Never waits.
  bool stroke(const BladeSweep& sweep) noexcept { return orders_.stroke(sweep); }
  Status begin_tick() noexcept {
    const bool behind = orders_.are_open() || failed_.load(std::memory_order_acquire);
    if (views_.update() && contact().cut != revision_) {  // folding changes nothing that a session remembers
      renewed_ = true;
      revision_ = contact().cut;
    }
    Status status;
    if (behind || contact().left_out) status.set(StatusFlag::degraded_model);
    return status;
  }
  /// Puts a session's contact on a new surface, where it goes on.
  void exchange_contacts(ContactProblem& problem) noexcept {
    if (std::exchange(renewed_, false)) problem.move_to(contact().problem, contact().surface);
  }
  /// Refuses a session whose tools are not those of the options.
  void require_tools(double smallest_radius, const ContactParameters& contact) const {
    if (smallest_radius != smallest_tool_ || contact.sample_spacing != parameters_.sample_spacing)
      raise(SetupErrorKind::bad_argument,
            "the session's smallest tool has a radius of " + number(smallest_radius) + " and a sample spacing of " +
                number(contact.sample_spacing) + ", the tissue was made for " + number(smallest_tool_) + " and " +
                number(parameters_.sample_spacing),
            "Give CuttableOptions the same smallest_tool and contact as the session");
  }
  const ContactSurface& contact_surface() const noexcept { return contact().surface; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return view().compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return revision_; }
  double compliance_bound(int j) const noexcept { return view().bound[static_cast<std::size_t>(j)]; }
  double compliance_floor() const noexcept { return view().floor; }
  const Eigen::Isometry3d& to_world() const noexcept { return world_; }
  /// Dofs whose correction a tick adds up at present.
  Index open_rank() const noexcept { return view().step->rank(); }

 private:
  CuttableTissue(CutPreparation<E> prepared, const CuttableOptions& options)
      : CuttableTissue(prepared, options, ScopedIdTranslation(prepared.ids)) {}
  CuttableTissue(CutPreparation<E>& prepared, const CuttableOptions& options, const ScopedIdTranslation&)
      : physics_(std::move(prepared.physics)),
        topology_(std::move(prepared.topology)),
        touchable_(std::move(prepared.touchable)),
        cuttable_(std::move(prepared.cuttable)),
        limits_(options.limits),
        system_(topology_, physics_, kept_nodes(), limits_),
        origin_(prepared.origin),
        world_(make_pose(Matrix3::Identity(), prepared.origin)),
        elements_(topology_.mesh().element_count()),
        smallest_tool_(options.smallest_tool),
        parameters_(options.contact),
        most_added_(options.most_added),
        tolerated_error_(options.tolerated_error) {
    report_.kept = system_.kept();
    make_contact();
    if (contact_->left_out) require_dense_surface(prepared.loads);
    publish_exactly();
    views_.update();
  }

  /// Refuses what the smallest tool would fall through before anything is cut.
  void require_dense_surface(const std::string& loads) const {
    ContactSurface whole(contact_->surface.positions(), touchable_.triangles());
    std::vector<Vector3> unloaded;
    for (const NodeId node : touchable_.nodes()) unloaded.push_back(topology_.mesh().position(node));
    whole.set_unloaded({std::move(unloaded), loads});
    require_dense_points(whole, smallest_tool_);
  }

  static void require_element(bool holds, Index e) {
    if (!holds)
      raise(SetupErrorKind::index_out_of_range, "a cut names element " + std::to_string(e) + " or a face it has not");
  }

  /// What is put off while cuts wait.
  enum class Check { error, inside, bounds };
  static constexpr std::size_t checks = 3;
  static constexpr int most_unchecked = 8;

  bool& is_due(Check check) noexcept { return due_[static_cast<std::size_t>(check)]; }
  void measure() {
    report_.error = system_.measured_error();
    report_.unchecked = 0;
  }

  std::vector<NodeId> kept_nodes() const {
    std::vector<NodeId> nodes;
    for (std::size_t v = 0; v < touchable_.nodes().size(); ++v)
      if (touchable_.is_used(v)) nodes.push_back(touchable_.nodes()[v]);
    for (NodeId node = 0; node < topology_.mesh().node_count(); ++node)
      if (std::ranges::binary_search(cuttable_, topology_.origin_of(node))) nodes.push_back(node);
    sort_unique(nodes);
    return nodes;
  }

  /// As faces and elements: blades cut the body as it lies now.
  CutOrder order_of(const CutOrders::Taken& taken) {
    CutOrder all = taken.order;
    if (!taken.sweeps.empty() && std::exchange(is_due(Check::inside), false)) system_.recover();
    for (const BladeSweep& s : taken.sweeps) {
      const auto local = [&](const Vector3& x) { return Vector3(x - origin_); };
      const auto faces = swept_faces(topology_, {local(s.a0), local(s.b0), local(s.a1), local(s.b1)},
                                     [&](NodeId node) { return position(node); });
      all.open.insert(all.open.end(), faces.begin(), faces.end());
    }
    return all;
  }

  /// Updates the system and makes it felt; where rounding leaves nothing to stand on, from a new factor.
  void take_in(const TopologyChange<E>& change) {
    try {
      ++cut_;
      const auto step = system_.update(topology_, change);
      report_.rank = step->rank();
      report_.smallest = step->smallest;
      make_contact();
      CutView made{contact_, step};
      made.bound_by(bound_);
      publish(std::move(made));
    } catch (const SetupError&) {
      renew();
    }
  }
  /// Folds. What is put off comes in turn from the eighth cut on, however many wait.
  void settle() {
    if (report_.failed) return;
    system_.fold();
    report_.kept = system_.kept();
    CutView made{contact_, system_.folded_step()};
    made.bound_as(bound_);
    publish(std::move(made));
    due_.fill(true);
    if (++report_.unchecked >= most_unchecked) check_next();
  }
  /// Does the next of what is due; false when nothing is.
  bool check_next() {
    for (std::size_t k = 0; k < checks; ++k) {
      last_check_ = (last_check_ + 1) % checks;
      if (!std::exchange(due_[last_check_], false)) continue;
      switch (static_cast<Check>(last_check_)) {
        case Check::error:
          check_error();
          break;
        case Check::inside:
          system_.recover();
          break;
        case Check::bounds:
          publish_exactly();
          break;
      }
      return true;
    }
    return false;
  }
  void check_error() {
    measure();
    if (!(report_.error <= tolerated_error_))
      renew();
    else if (system_.added() > most_added_ && !renewal_)
      renewal_ = std::make_unique<CutRenewal<E>>(topology_, physics_, kept_nodes(), limits_);
  }
  /// Takes over a new factor when one is ready, with what was cut since it was begun.
  bool take_renewal() {
    if (!renewal_ || !renewal_->is_done()) return false;
    try {
      if (auto made = renewal_->take(topology_)) take_over(std::move(*made));
    } catch (const SetupError&) {  // the old one goes on
    }
    renewal_.reset();
    return true;
  }
  void renew() {
    renewal_.reset();
    try {
      take_over(CutSystem<E>(topology_, physics_, kept_nodes(), limits_));
    } catch (const SetupError&) {
      report_.failed = true;
      due_.fill(false);
      failed_.store(true, std::memory_order_release);  // ticks go on saying degraded_model
    }
  }
  void take_over(CutSystem<E>&& fresh) {
    system_ = std::move(fresh);
    ++report_.renewals;
    ++cut_;
    report_.kept = system_.kept();
    measure();
    system_.recover();
    make_contact();
    publish_exactly();
    due_.fill(false);
  }

  Vector3 position(NodeId node) const noexcept {
    const Index dof = 3 * Index{node};
    Vector3 x = topology_.mesh().position(node);
    if (dof < system_.displacement().size()) x += system_.displacement().template segment<3>(dof);
    return x;
  }
  void make_contact() {
    std::vector<Vector3> positions;
    for (const NodeId node : touchable_.nodes()) positions.push_back(position(node));
    contact_ =
        std::make_shared<CutContact>(system_, touchable_, std::move(positions), smallest_tool_, parameters_, cut_);
  }
  void publish_exactly() {
    CutView made{contact_, system_.folded_step()};
    made.bound_exactly();
    publish(std::move(made));
  }
  void publish(CutView&& made) {
    bound_ = made.bound;
    views_.back() = std::move(made);  // frees what no tick can see any more
    views_.publish();
  }
  const CutView& view() const noexcept { return views_.front(); }
  CutContact& contact() const noexcept { return *view().contact; }

  CutPhysics<E> physics_;
  CutTopology<E> topology_;
  CutSurface<E> touchable_;
  std::vector<NodeId> cuttable_;  // sorted, of the given mesh
  SetupLimits limits_;
  CutSystem<E> system_;
  Vector3 origin_;
  Eigen::Isometry3d world_;
  Index elements_;
  double smallest_tool_;
  ContactParameters parameters_;
  Index most_added_;
  double tolerated_error_;
  CutReport report_;
  std::shared_ptr<CutContact> contact_;  // of the last cut
  std::vector<double> bound_;            // of the last view
  std::array<bool, checks> due_{};
  std::size_t last_check_ = 0;
  mutable std::mutex system_mutex_;
  CutOrders orders_;
  std::atomic<bool> failed_{false};
  TripleBuffer<CutView> views_;
  std::uint64_t cut_ = 0, revision_ = 0;  // made last; seen last by a tick
  bool renewed_ = false;
  std::unique_ptr<CutRenewal<E>> renewal_;  // last: its thread refers to the physics
};

}}  // namespace palpate
