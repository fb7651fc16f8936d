// Applies cuts to a body, and the checks after a cut.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/cut/cut_parameters.hpp>
#include <palpate/cut/detail/apply_orders.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_preparation.hpp>
#include <palpate/cut/detail/cut_renewal.hpp>
#include <palpate/cut/detail/cut_state.hpp>
#include <palpate/cut/detail/cut_surface.hpp>
#include <palpate/cut/detail/cut_system.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/cut/detail/resting_nodes.hpp>

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A body that is cut. Every change publishes a view for the tick. One thread at a time: CuttableTissue locks it.
/// Neither copied nor moved.
template <Element E>
class CutProcess : public CutState<E> {
 public:
  using State = CutState<E>;
  using typename State::Publish;

  /// Enters stages, memory and accuracy into the report. Throws as factorisation, and ill_conditioned.
  CutProcess(CutPreparation<E> prepared, const CutParameters& parameters, const SetupLimits& limits, Publish publish_to,
             SetupReport& report)
      : State(std::move(prepared), limits, std::move(publish_to), report),
        whole_topology_(topology_),
        whole_surface_(touchable_),
        parameters_(parameters) {
    constexpr double share = 0.5, floor = 0.02;  // of the quality of the worst element; slivers make no others
    for (Index e = 0; e < topology_.mesh().element_count(); ++e)
      least_quality_ = std::min(least_quality_, share * topology_.quality(e));
    least_quality_ = std::max(least_quality_, floor);
    remember();
  }

  /// Applies all orders as one cut: publishes the updated compliance, then folds the update in. Without orders, runs
  /// one of the deferred checks. True when there was something to do. `local` maps the world to the frame of the mesh.
  /// Throws when memory is short; the body is then that before the orders, or, if its compliance was complete, that
  /// after them, and the next call publishes it.
  bool process(const CutOrders::Taken& taken, const Eigen::Isometry3d& local) {
    const bool renewed = take_renewal(), caught_up = catch_up();
    if (taken.count == 0) return caught_up || check_next() || renewed;
    if (!before_) remember();
    const CutReport before = report_;
    has_new_compliance_ = false;
    run_or_undo([&] { cut(taken, local); },
                [&] {
                  report_.failed = true;
                  is_behind_ = has_new_compliance_;
                  if (has_new_compliance_) return;
                  go_back();
                  report_.cuts = before.cuts;
                  report_.changes = before.changes;
                  report_.quality = before.quality;
                  report_.off_sheet = before.off_sheet;
                });
    return true;
  }

  /// Forces on vertices with which blades find the body displaced, besides its loads.
  void set_contact_forces(std::span<const VertexForce> forces) { contact_forces_.assign(forces.begin(), forces.end()); }

  /// Replaces loads and prescribed values; a new factor. Strong guarantee.
  void set_loads(const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    auto physics = std::make_unique<CutPhysics<E>>(physics_->body, boundary, scene);
    CutSystem<E> fresh(topology_, *physics, kept_nodes(), limits_);
    renewal_.reset();
    replace_system(std::move(fresh));
    physics_.swap(physics);
    swept_.resize(0);
  }
  /// Restores the uncut body under these loads; a new factor. Strong guarantee.
  void reset(const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    CutTopology<E> topology = whole_topology_;
    CutSurface<E> touchable = whole_surface_;
    std::swap(topology_, topology);
    std::swap(touchable_, touchable);
    RestingNodes resting;
    std::swap(resting_, resting);
    const auto undo = [&] {
      std::swap(topology_, topology);
      std::swap(touchable_, touchable);
      std::swap(resting_, resting);
    };
    run_or_undo([&] { set_loads(boundary, scene); }, undo);
    edges_.clear();
    contact_forces_.clear();
    before_.reset();
    const CutReport before = std::exchange(report_, CutReport{});
    report_.kept = system_.kept();
    report_.error = before.error;
    report_.changes = before.changes + 1;
    report_.displacement = before.displacement;
  }

 private:
  using State::bound_;
  using State::contact_;
  using State::cut_;
  using State::diagonal_;
  using State::kept_nodes;
  using State::limits_;
  using State::make_contact;
  using State::physics_;
  using State::publish;
  using State::publish_exactly;
  using State::report_;
  using State::resting_;
  using State::system_;
  using State::topology_;
  using State::touchable_;

  /// Checks deferred while orders wait.
  enum class Check { error, inside, bounds };
  static constexpr std::size_t checks = 3;
  static constexpr int most_unchecked = 8;

  /// What an order changes beside the compliance.
  struct Parts {
    CutTopology<E> topology;
    CutSurface<E> touchable;
    RestingNodes resting;
    RestingEdges edges;
  };
  /// Copies these parts, so that an order can be taken back.
  void remember() { before_ = Parts{topology_, touchable_, resting_, edges_}; }
  void go_back() noexcept {
    topology_ = std::move(before_->topology);
    touchable_ = std::move(before_->touchable);
    resting_ = std::move(before_->resting);
    edges_ = std::move(before_->edges);
    before_.reset();
  }
  void cut(const CutOrders::Taken& taken, const Eigen::Isometry3d& local) {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const auto [change, off_sheet] = apply(taken, local);
    if (change.empty()) return;
    report_.off_sheet = off_sheet;
    for (const ChangedElement<E>& x : change.elements)
      if (!x.removed) report_.quality = std::min(report_.quality, topology_.quality(x.element));
    ++report_.cuts;
    ++report_.changes;
    rest_fragments(change);
    touchable_.update(topology_, change);
    update_compliance(change);
    report_.latency = seconds();
    fold_update();
    report_.fold_seconds = seconds();
    if (!attempt([&] { remember(); })) before_.reset();  // the next cut tries again
  }
  /// Fragments stay as they were displaced before this cut: also by tools and other tissues, so that tools keep
  /// their grip on one.
  void rest_fragments(const TopologyChange<E>& change) {
    constexpr double beside_tools = 3.0;  // a tool moves a part that hangs on little farther than loads may
    if (!change.fragments.empty()) system_.recover();
    const double largest = largest_linear_displacement * diagonal_ * (contact_forces_.empty() ? 1.0 : beside_tools);
    if (change.fragments.empty() || contact_forces_.empty())
      resting_.update(topology_, change, system_.displacement(), largest);
    else
      resting_.update(topology_, change, displacement_beside_others(), largest);
  }
  /// Completes a cut that ended early because memory was short; true when there was one.
  bool catch_up() {
    const bool behind = is_behind_;
    if (behind) {
      system_.fold();
      ++cut_;
      make_contact();
      publish_exactly();
      report_.kept = system_.kept();
      report_.failed = is_behind_ = false;
      due_.fill(true);
    }
    return behind;
  }

  bool& is_due(Check check) noexcept { return due_[static_cast<std::size_t>(check)]; }
  void measure() {
    report_.error = system_.measured_error();
    report_.unchecked = 0;
  }

  /// Blades cut the deformed body. Where cuts displace it too far for linear elasticity, they cut it as it was deformed
  /// before.
  AppliedOrders<E> apply(const CutOrders::Taken& taken, const Eigen::Isometry3d& local) {
    if (!taken.sweeps.empty()) {
      if (is_due(Check::inside)) system_.recover();
      is_due(Check::inside) = false;
      if (swept_.size() == 0 || report_.displacement <= largest_linear_displacement) {
        VectorX swept = displacement_beside_others();  // an assignment that finds no memory would leave it broken
        swept_.swap(swept);
      }
    }
    const auto swept = [&](NodeId node) {
      NodeId known = node;
      while (3 * Index{known} >= swept_.size()) known = topology_.copied_from(known);
      return Vector3(topology_.mesh().position(node) +
                     (resting_.rests(node) ? resting_.displacement(node) : node_vector(swept_, known)));
    };
    if constexpr (follows_sheets<E>)
      if (parameters_.straight) {
        const auto is_fixed = [&](NodeId node) { return physics_->has_own_condition(topology_.origin_of(node)); };
        return apply_orders(topology_, taken, local, swept, edges_,
                            FollowSheet<decltype(is_fixed)>{least_quality_, is_fixed});
      }
    return apply_orders(topology_, taken, local, swept, edges_, KeepElements());
  }

  VectorX displacement_beside_others() {
    return contact_forces_.empty() ? system_.displacement() : State::displacement_with(contact_forces_);
  }

  /// Updates the compliance and publishes it. Makes a new factor if the update is not positive definite to working
  /// precision.
  void update_compliance(const TopologyChange<E>& change) {
    if (!follows_topology_) return renew();
    const bool is_taken = attempt_unless_refused([&] {
      ++cut_;
      const auto step = system_.update(topology_, change);
      has_new_compliance_ = true;
      report_.rank = step->rank();
      report_.smallest = step->smallest;
      make_contact();
      CutView made{contact_, step};
      made.bound_by(bound_);
      publish(std::move(made));
      report_.failed = false;
    });
    if (!is_taken) renew();
  }
  /// Folds the update in. From the eighth unchecked cut on, runs one deferred check even if orders wait.
  void fold_update() {
    if (report_.failed) return;
    system_.fold();
    report_.kept = system_.kept();
    CutView made{contact_, system_.folded_step()};
    made.bound_as(bound_);
    publish(std::move(made));
    due_.fill(true);
    if (++report_.unchecked >= most_unchecked) check_next();
  }
  /// Runs the next check that is due; false when none is.
  bool check_next() {
    for (std::size_t k = 0; k < checks; ++k) {
      last_check_ = (last_check_ + 1) % checks;
      if (!due_[last_check_]) continue;
      run_check(static_cast<Check>(last_check_));  // stays due when memory is short
      due_[last_check_] = false;
      return true;
    }
    return false;
  }
  void run_check(Check check) {
    switch (check) {
      case Check::error:
        return check_error();
      case Check::inside:
        return system_.recover();
      case Check::bounds:
        return publish_exactly();
    }
  }
  void check_error() {
    measure();
    if (!(report_.error <= parameters_.tolerated_error))
      renew();
    else if (system_.added() > parameters_.most_added && !renewal_)
      renewal_ = std::make_unique<CutRenewal<E>>(topology_, *physics_, kept_nodes(), limits_);
  }
  /// Switches to a new factor when one is ready, with the cuts made since it was started.
  bool take_renewal() {
    if (!renewal_ || !renewal_->is_done()) return false;
    attempt_unless_refused([&] {  // otherwise the old factor stays
      if (auto made = renewal_->take(topology_)) replace_system(std::move(*made));
    });
    renewal_.reset();
    return true;
  }
  void renew() {
    renewal_.reset();
    if (attempt_unless_refused([&] { replace_system(CutSystem<E>(topology_, *physics_, kept_nodes(), limits_)); }))
      return;
    report_.failed = true;
    follows_topology_ = false;
    due_.fill(false);
  }
  /// Strong guarantee.
  void replace_system(CutSystem<E>&& fresh) {
    const double error = fresh.measured_error();
    fresh.recover();
    std::swap(system_, fresh);
    const auto contact = contact_;
    ++cut_;
    const auto publish_it = [&] {
      make_contact();
      publish_exactly();
    };
    run_or_undo(publish_it, [&] {
      std::swap(system_, fresh);
      contact_ = contact;
    });
    follows_topology_ = has_new_compliance_ = true;
    is_behind_ = false;
    ++report_.renewals;
    report_.kept = system_.kept();
    report_.failed = false;
    report_.error = error;
    report_.unchecked = 0;
    due_.fill(false);
  }

  CutTopology<E> whole_topology_;
  CutSurface<E> whole_surface_;
  CutParameters parameters_;
  double least_quality_ = 1.0;  // of elements after a cut
  RestingEdges edges_;
  std::vector<VertexForce> contact_forces_;  // of other tissues and tools
  VectorX swept_;                            // displacement of the nodes through which blades cut
  std::optional<Parts> before_;              // the last order
  bool follows_topology_ = true;             // the compliance is that of the topology
  bool has_new_compliance_ = true;           // it has that of the present order
  bool is_behind_ = false;                   // it is not published, because memory was short
  std::array<bool, checks> due_{};
  std::size_t last_check_ = 0;
  std::unique_ptr<CutRenewal<E>> renewal_;  // declared last: its thread refers to the physics
};

}}}  // namespace palpate::detail
