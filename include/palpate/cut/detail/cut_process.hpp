// A body under cuts: its topology, compliance and contact surface, and the checks after a cut.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/cut/cut_parameters.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_preparation.hpp>
#include <palpate/cut/detail/cut_renewal.hpp>
#include <palpate/cut/detail/cut_surface.hpp>
#include <palpate/cut/detail/cut_system.hpp>
#include <palpate/cut/detail/cut_topology.hpp>
#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/cut/detail/resting_nodes.hpp>
#include <palpate/cut/detail/swept_faces.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A body that is cut. Every change publishes a view for the tick. One thread at a time: CuttableTissue locks it.
/// Neither copied nor moved.
template <Element E>
class CutProcess {
 public:
  using Publish = std::function<void(CutView&&)>;

  /// Throws as factorisation.
  CutProcess(CutPreparation<E> prepared, const CutParameters& parameters, const SetupLimits& limits, Publish publish)
      : physics_(std::make_unique<CutPhysics<E>>(std::move(prepared.physics))),
        topology_(std::move(prepared.topology)),
        touchable_(std::move(prepared.touchable)),
        whole_topology_(topology_),
        whole_surface_(touchable_),
        cuttable_(std::move(prepared.cuttable)),
        limits_(limits),
        parameters_(parameters),
        publish_to_(std::move(publish)),
        system_(topology_, *physics_, kept_nodes(), limits_),
        diagonal_(box_of(topology_.mesh().positions).size().norm()) {
    report_.kept = system_.kept();
    make_contact();
    publish_exactly();
  }
  CutProcess(const CutProcess&) = delete;
  CutProcess& operator=(const CutProcess&) = delete;

  /// Applies all orders as one cut: publishes the updated compliance, then folds the update in. Without orders, runs
  /// one of the deferred checks. True when there was something to do. `local` maps the world to the frame of the mesh.
  bool process(const CutOrders::Taken& taken, const Eigen::Isometry3d& local) {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const bool renewed = take_renewal();
    if (taken.count == 0) return check_next() || renewed;
    const TopologyChange<E> change = topology_.apply(order_of(taken, local));
    if (change.empty()) return true;
    ++report_.cuts;
    ++report_.changes;
    if (!change.fragments.empty()) system_.recover();  // displacement before this cut
    resting_.update(topology_, change, system_.displacement(), largest_linear_displacement * diagonal_);
    touchable_.update(topology_, change);
    take_in(change);
    report_.latency = seconds();
    settle();
    report_.fold_seconds = seconds();
    return true;
  }

  /// Replaces loads and prescribed values; a new factor. Strong guarantee.
  void set_loads(const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    auto physics = std::make_unique<CutPhysics<E>>(physics_->body, boundary, scene);
    CutSystem<E> fresh(topology_, *physics, kept_nodes(), limits_);
    renewal_.reset();
    swept_.resize(0);
    physics_.swap(physics);
    take_over(std::move(fresh));
  }
  /// Restores the uncut body under these loads; a new factor. Strong guarantee.
  void reset(const std::vector<BoundaryFace>& boundary, const Scene& scene) {
    CutTopology<E> topology = whole_topology_;
    CutSurface<E> touchable = whole_surface_;
    std::swap(topology_, topology);
    std::swap(touchable_, touchable);
    RestingNodes resting;
    std::swap(resting_, resting);
    try {
      set_loads(boundary, scene);
    } catch (...) {
      std::swap(topology_, topology);
      std::swap(touchable_, touchable);
      std::swap(resting_, resting);
      throw;
    }
    edges_.clear();
    const CutReport before = std::exchange(report_, CutReport{});
    report_.kept = system_.kept();
    report_.error = before.error;
    report_.changes = before.changes + 1;
    report_.displacement = before.displacement;
  }
  /// Rebuilds the contact surface for these tools. Before the first cut, throws what require_dense_points throws;
  /// `loads` describes the scene's loads in its message. Strong guarantee.
  void set_tools(const ToolRadii& radii, const ContactParameters& parameters, const std::string& loads) {
    if (radii == tools_.radii && parameters.sample_spacing == tools_.contact.sample_spacing) return;
    const Tools before = std::exchange(tools_, {radii, parameters});
    const auto surface = contact_;
    ++cut_;
    try {
      make_contact();
      if (contact_->left_out && report_.cuts == 0) require_dense_surface(radii.smallest, loads);
    } catch (...) {
      tools_ = before;
      contact_ = surface;
      throw;
    }
    publish_exactly();
  }

  /// Displacement of all nodes with forces on vertices, 3 per node [m].
  VectorX displacement_with(std::span<const VertexForce> forces) {
    require_vertex_forces(forces, static_cast<int>(touchable_.nodes().size()));
    std::vector<std::pair<NodeId, Vector3>> list;
    for (const VertexForce& f : forces)
      list.push_back({touchable_.nodes()[static_cast<std::size_t>(f.vertex)], f.force.in_model_axes()});
    VectorX u = system_.displacement_with(list);
    resting_.place(u);
    return u;
  }

  const CutReport& report() const noexcept { return report_; }
  const CutTopology<E>& topology() const noexcept { return topology_; }
  const CutPhysics<E>& physics() const noexcept { return *physics_; }

 private:
  /// Checks deferred while orders wait.
  enum class Check { error, inside, bounds };
  static constexpr std::size_t checks = 3;
  static constexpr int most_unchecked = 8;

  /// The tools that the contact surface is made for. Radius 0, before the first session: a tool large enough that no
  /// triangle is left out.
  struct Tools {
    ToolRadii radii = 0.0;
    ContactParameters contact{};
  };
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

  /// All orders as faces and elements. Blades cut the deformed body. Where cuts displace it too far for linear
  /// elasticity, they cut it as it was deformed before.
  CutOrder order_of(const CutOrders::Taken& taken, const Eigen::Isometry3d& local) {
    if (!taken.sweeps.empty()) {
      if (std::exchange(is_due(Check::inside), false)) system_.recover();
      if (swept_.size() == 0 || report_.displacement <= largest_linear_displacement) swept_ = system_.displacement();
    }
    const auto swept = [&](NodeId node) {
      NodeId known = node;
      while (3 * Index{known} >= swept_.size()) known = topology_.copied_from(known);
      return Vector3(topology_.mesh().position(node) +
                     (resting_.rests(node) ? resting_.displacement(node) : node_vector(swept_, known)));
    };
    return combined(taken, topology_, local, swept, edges_);
  }

  /// Updates the compliance and publishes it. Makes a new factor if the update is not positive definite to working
  /// precision.
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
  /// Folds the update in. From the eighth unchecked cut on, runs one deferred check even if orders wait.
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
  /// Runs the next check that is due; false when none is.
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
    if (!(report_.error <= parameters_.tolerated_error))
      renew();
    else if (system_.added() > parameters_.most_added && !renewal_)
      renewal_ = std::make_unique<CutRenewal<E>>(topology_, *physics_, kept_nodes(), limits_);
  }
  /// Switches to a new factor when one is ready, with the cuts made since it was started.
  bool take_renewal() {
    if (!renewal_ || !renewal_->is_done()) return false;
    try {
      if (auto made = renewal_->take(topology_)) take_over(std::move(*made));
    } catch (const SetupError&) {  // keep the old factor
    }
    renewal_.reset();
    return true;
  }
  void renew() {
    renewal_.reset();
    try {
      take_over(CutSystem<E>(topology_, *physics_, kept_nodes(), limits_));
    } catch (const SetupError&) {
      report_.failed = true;
      due_.fill(false);
    }
  }
  void take_over(CutSystem<E>&& fresh) {
    system_ = std::move(fresh);
    ++report_.renewals;
    ++cut_;
    report_.kept = system_.kept();
    report_.failed = false;
    measure();
    system_.recover();
    make_contact();
    publish_exactly();
    due_.fill(false);
  }

  Vector3 position(NodeId node) const noexcept {
    const Index dof = 3 * Index{node};
    Vector3 x = topology_.mesh().position(node);
    if (resting_.rests(node)) return x + resting_.displacement(node);
    if (dof < system_.displacement().size()) x += system_.displacement().template segment<3>(dof);
    return x;
  }
  /// Refuses a surface that a tool of this radius would fall through.
  void require_dense_surface(double radius, const std::string& loads) const {
    ContactSurface whole(contact_->surface.positions(), touchable_.triangles());
    std::vector<Vector3> unloaded;
    for (const NodeId node : touchable_.nodes()) unloaded.push_back(topology_.mesh().position(node));
    whole.set_unloaded({std::move(unloaded), loads});
    require_dense_points(whole, radius);
  }
  double longest_edge(const std::vector<Vector3>& positions) const {
    double longest = 0.0;
    for (const Triangle& t : touchable_.triangles())
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(t[i % 3])]; };
        longest = std::max(longest, (at(k) - at(k + 1)).norm());
      }
    return longest > 0.0 ? longest : 1.0;
  }
  /// Displacements of the touchable vertices that exist [m].
  std::vector<Vector3> displacements_to(const std::vector<Vector3>& positions) const {
    std::vector<Vector3> displacements;
    for (std::size_t v = 0; v < positions.size(); ++v)
      if (touchable_.is_used(v))
        displacements.push_back(positions[v] - topology_.mesh().position(touchable_.nodes()[v]));
    return displacements;
  }
  void make_contact() {
    std::vector<Vector3> positions;
    for (const NodeId node : touchable_.nodes()) positions.push_back(position(node));
    const ToolRadii radii = tools_.radii.smallest > 0.0 ? tools_.radii : ToolRadii(longest_edge(positions));
    report_.displacement = displacement_spread(displacements_to(positions)) / diagonal_;
    contact_ = std::make_shared<CutContact>(system_, touchable_, std::move(positions), radii, tools_.contact, cut_);
    contact_->too_far = !(report_.displacement <= largest_linear_displacement);
  }
  void publish_exactly() {
    CutView made{contact_, system_.folded_step()};
    made.bound_exactly();
    publish(std::move(made));
  }
  void publish(CutView&& made) {
    bound_ = made.bound;
    publish_to_(std::move(made));
  }

  std::unique_ptr<CutPhysics<E>> physics_;
  CutTopology<E> topology_;
  CutSurface<E> touchable_;
  CutTopology<E> whole_topology_;
  CutSurface<E> whole_surface_;
  std::vector<NodeId> cuttable_;  // sorted, node ids of the given mesh
  SetupLimits limits_;
  CutParameters parameters_;
  Tools tools_;
  Publish publish_to_;
  CutSystem<E> system_;
  RestingNodes resting_;
  RestingEdges edges_;
  VectorX swept_;    // displacement of the nodes through which blades cut
  double diagonal_;  // of the bounding box [m]
  CutReport report_;
  std::shared_ptr<CutContact> contact_;  // of the last cut
  std::vector<double> bound_;            // of the last view
  std::array<bool, checks> due_{};
  std::size_t last_check_ = 0;
  std::uint64_t cut_ = 0;                   // number of the last cut
  std::unique_ptr<CutRenewal<E>> renewal_;  // declared last: its thread refers to the physics
};

}}  // namespace palpate
