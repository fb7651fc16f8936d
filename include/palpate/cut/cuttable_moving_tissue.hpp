// Moving tissue at large strain that can be touched while it is cut.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/cut/cut_parameters.hpp>
#include <palpate/cut/detail/cut_half_space.hpp>
#include <palpate/cut/detail/cut_motion.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_surface.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/cut/detail/slit_sides.hpp>
#include <palpate/cut/detail/apply_orders.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/moving/moving_tissue.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A moving body of elements E under cuts. Base of HapticFEModel on Cuttable<Implicit<QuasiNewton<...>>>. `cut` orders
/// a cut; the next `advance` applies all orders before its step, so the first tick after that step feels them. Vertex
/// numbers never change, so contact forces continue across a cut. While an order is open, ticks report degraded_model.
///
/// A step after a cut uses the factor of an earlier body, extended to the new nodes (CutFactor), until a thread has
/// computed the present one: it may take more iterations. Compliances stay those of the set-up; the lips of slits are
/// separated (VertexCompliance). Steady forces are right, changes between two steps are predicted less well. A step
/// that applies a cut allocates, takes O(elements) in addition, and ends at the tolerance or after a few iterations:
/// the next step continues, and a residual above 5 % is flagged (solver_not_converged).
///
/// Fragments that a cut detaches stay where they were, without forces; tools do not touch them. Threads: as
/// MovingTissue; `try_cut` belongs to the thread that ticks, `cut`, `cut_report` and `read` may be called from any
/// thread. `reset` must not run during a tick. All but the functions of the ticking thread may wait for a step.
/// Satisfies TissueModel; one session at a time.
template <Element E>
class CuttableMovingTissue : public MovingTissue {
 public:
  // Any thread

  /// Orders a cut. Immediately throws index_out_of_range for invalid ids.
  void cut(CutOrder order) {
    detail::require_ids<E>(order, elements_);
    orders_.add(std::move(order));
  }
  /// Orders a cut along the sheet swept by a blade, in the world's frame, through the deformed body.
  void cut(const BladeSweep& sweep) { orders_.add(sweep); }
  /// `renewals` counts factors computed since the set-up, `failed` is set when there was no memory for a cut. Fields of
  /// the compliance are not used.
  CutReport cut_report() {
    const std::scoped_lock lock(changes());
    CutReport report = report_;
    report.renewals = static_cast<std::uint64_t>(cut_motion_->renewals());
    return report;
  }
  /// Visits the topology; no cut is applied meanwhile.
  template <class Visit>
  void read(Visit&& visit) {
    const std::scoped_lock lock(changes());
    visit(std::as_const(body_->topology));
  }
  /// Restores the uncut body with scene, pose and state of construction; drops waiting orders and the vertices that
  /// cuts have created. Not during a tick.
  void reset() {
    const std::scoped_lock lock(changes());
    if (const detail::CutOrders::Taken taken = orders_.take(); taken.count > 0) orders_.done(taken);
    body_ = whole_;
    edges_.clear();
    similar_.resize(known_);
    cut_motion_->restart(body_->topology);
    rest_at_start();  // as at the set-up, for the contact points of the surface
    change_surface();
    failed_.store(false, std::memory_order_release);
    halted_ = false;
    report_ = {.changes = report_.changes + 1};
    restart();
  }

  // One thread that draws

  /// As MovingTissue; includes the nodes that cuts have created. Throws as there.
  VectorX displacement(std::span<const VertexForce> forces = {}) {
    {
      const std::scoped_lock lock(this->changes());
      detail::require_vertex_forces(forces, static_cast<int>(similar_.size()));
    }
    VectorX u;
    this->displacement_with(forces, u);
    return u;
  }

  // The thread that ticks

  /// Orders a cut from a tick; returns false when too many are waiting. Never waits.
  bool try_cut(const BladeSweep& sweep) noexcept { return orders_.try_add(sweep); }
  Status begin_tick() noexcept { return MovingTissue::begin_tick() | order_status(); }
  bool has_orders() const noexcept { return orders_.are_open(); }
  /// degraded_model while an order is open, or after a cut has failed.
  Status order_status() const noexcept {
    Status status;
    if (orders_.are_open() || failed_.load(std::memory_order_acquire)) status.set(StatusFlag::degraded_model);
    return status;
  }
  /// Moves a session's contact to a new surface.
  void exchange_contacts(ContactProblem& problem) noexcept {
    const std::uint64_t before = std::exchange(seen_, this->surface_number());
    if (seen_ != before && this->surface_contact() != nullptr)
      problem.move_to(*this->surface_contact(), this->contact_surface());
  }
  /// Makes the contact surface for the tools of a session that begins; not while another session ticks.
  void prepare_tools(const ToolRadii& radii, const ContactParameters& contact) {
    MovingTissue::prepare_tools(radii, contact);
    const std::scoped_lock lock(changes());
    tools_ = {radii, contact};
    if (report_.cuts > 0 || left_out_) {  // otherwise it is that of the body without cuts
      change_surface();
      publish({});
    }
    take_surface();
    seen_ = surface_number();
  }

 protected:
  explicit CuttableMovingTissue(const SetupOptions& options) : MovingTissue(options) {}

  /// The set-up after admission. Throws as MovingTissue, and unsupported for a mesh whose parts touch only at nodes or
  /// edges.
  template <HyperelasticMaterial M, class S>
  void set_up_cuts(HyperelasticBody<E, M> body, const std::vector<BoundaryFace>& boundary,
                   const detail::Touchable& touchable, const QuasiNewtonParameters& parameters) {
    const Mesh<E>& mesh = body.rest.mesh;
    CutTopology<E> topology(mesh, resolve_essential(mesh, boundary, scene()).constrained);
    if (topology.mesh().node_count() > mesh.node_count())
      raise(SetupErrorKind::unsupported, "a mesh whose parts touch only at nodes or edges",
            "Give each part its own nodes there");
    elements_ = mesh.element_count();
    detail::CutSurface<E> surface(topology, boundary, scene());
    body_ = whole_ = Parts{std::move(topology), std::move(surface)};
    const detail::BlockPattern pattern = detail::block_pattern(mesh);
    auto motion = std::make_unique<detail::CutQuasiNewtonMotion<E, M, S>>(std::move(body), body_->topology, scene(),
                                                                          parameters, limits());
    cut_motion_ = motion.get();
    PreparedMotion prepared;
    prepared.large_strain = true;
    prepared.start = motion->displacement();
    prepared.motion = std::move(motion);
    set_up(touchable, std::move(prepared), parameters.step, pattern);
    half_space_ = contact_surface().subfacet();
    known_ = touchable.nodes.size();
    for (std::size_t v = 0; v < known_; ++v) similar_.push_back(static_cast<int>(v));
  }

 private:
  struct Parts {
    CutTopology<E> topology;
    detail::CutSurface<E> surface;
  };
  struct Tools {
    ToolRadii radii = 0.0;  ///< 0: no session yet
    ContactParameters contact{};
  };

  /// An element takes its loads with it; copies of a node carry the loads of their elements.
  VectorX applied_load(const Scene& scene) const override {
    const detail::ElementLoads<E> loads(detail::mesh_of<E>(this->elastic_body()),
                                        detail::boundary_of<E>(this->elastic_body()), scene);
    const CutTopology<E>& topology = body_->topology;
    VectorX sum = VectorX::Zero(3 * topology.mesh().node_count());
    sum.head(loads.nodal_load.size()) = loads.nodal_load;
    for (Index e = 0; e < topology.mesh().element_count(); ++e) {
      if (topology.state(e) != ElementState::supported) continue;
      const ElementNodes<E> load = loads.applied_load(topology.part(e));
      for (int a = 0; a < E::nodes; ++a)
        add_node_vector(sum, Index{topology.mesh().element_node(e, a)}, Vector3(load.row(a).transpose()));
    }
    return sum;
  }
  bool prepare_step() noexcept override {
    if (halted_) return false;
    detail::CutOrders::Taken taken;
    std::optional<Parts> before;
    detail::RestingEdges edges;
    const Index size = cut_motion_->displacement().size();
    const auto work = [&] {
      taken = orders_.take();
      if (taken.count == 0) return;
      before = body_;
      edges = edges_;
      apply(taken);
    };
    if (!detail::attempt(work)) {
      failed_.store(true, std::memory_order_release);
      report_.failed = true;
      halted_ = cut_motion_->displacement().size() != size;  // memory ended between motion and surface
      if (before && !halted_) {
        body_.swap(before);
        std::swap(edges_, edges);
      }
    }
    if (taken.count > 0) orders_.done(taken);
    return !halted_;
  }
  void apply(const detail::CutOrders::Taken& taken) {
    const auto start = std::chrono::steady_clock::now();
    const auto [change, off_sheet] = detail::apply_orders(
        body_->topology, taken, inverse(to_world()), [&](NodeId node) { return position(node); }, edges_,
        detail::KeepElements());
    if (change.empty()) return;
    report_.off_sheet = off_sheet;
    body_->surface.update(body_->topology, change);
    cut_motion_->follow(body_->topology);
    change_surface();
    ++report_.cuts;
    ++report_.changes;
    report_.failed = false;
    failed_.store(false, std::memory_order_release);
    report_.latency = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  Vector3 position(NodeId node) const {
    const VectorX& u = cut_motion_->displacement();
    NodeId known = node;  // a cut that failed may have left nodes that the motion does not have
    while (3 * Index{known} >= u.size()) known = body_->topology.copied_from(known);
    return body_->topology.mesh().position(Index{node}) + node_vector(u, Index{known});
  }
  void change_surface() {
    const detail::CutSurface<E>& surface = body_->surface;
    find_similar();
    CutVertices made;
    made.nodes = surface.nodes();
    made.similar = similar_;
    std::vector<Vector3> positions;
    for (const NodeId node : made.nodes) positions.push_back(position(node));
    std::vector<Triangle> triangles = surface.triangles();
    std::vector<Index> elements = surface.elements();
    left_out_ = tools_.radii.smallest > 0.0 &&
                detail::erase_stretched(positions, detail::ContactSamples::maximum_subdivision * tools_.radii.smallest,
                                        triangles, elements);
    if (left_out_) made.status.set(StatusFlag::degraded_model);
    std::vector<NodeId> origin;
    for (const NodeId node : made.nodes) origin.push_back(body_->topology.origin_of(node));
    made.side = detail::slit_sides(surface.triangles(), origin);
    made.parent = parents();
    made.surface = ContactSurface(std::move(positions), std::move(triangles));
    made.surface.set_large_strain(true);
    made.surface.set_materials(elastic_body().contact_materials(elements));
    made.surface.set_subfacet(detail::half_space_after_cuts(half_space_, body_->topology, made.nodes));
    if (tools_.radii.smallest > 0.0)
      made.contact = std::make_shared<ContactProblem>(made.surface, tools_.radii, tools_.contact);
    const detail::CutBody& body = cut_motion_->body();
    MovingTissue::change_surface(std::move(made), body.nodal_mass, body.body.pattern, body.body.positions);
  }
  /// Per vertex the vertex of the node that its node was split from, or -1.
  std::vector<int> parents() const {
    const std::vector<NodeId>& nodes = body_->surface.nodes();
    std::vector<int> at(static_cast<std::size_t>(body_->topology.mesh().node_count()), -1), parent;
    for (std::size_t v = 0; v < nodes.size(); ++v) at[static_cast<std::size_t>(nodes[v])] = static_cast<int>(v);
    for (const NodeId node : nodes) {
      const NodeId from = body_->topology.copied_from(node);
      parent.push_back(from == node ? -1 : at[static_cast<std::size_t>(from)]);
    }
    return parent;
  }
  /// For new vertices the vertex of the set-up that was split, or the nearest one in the body at rest.
  void find_similar() {
    const std::vector<NodeId>& nodes = body_->surface.nodes();
    const Mesh<E>& mesh = body_->topology.mesh();
    for (std::size_t v = similar_.size(); v < nodes.size(); ++v) {
      int nearest = 0;
      double distance = infinity;
      for (std::size_t k = 0; k < known_; ++k) {
        const double d = (mesh.position(Index{nodes[k]}) - mesh.position(Index{nodes[v]})).squaredNorm();
        if (d < distance) distance = d, nearest = static_cast<int>(k);
      }
      similar_.push_back(nearest);
    }
  }

  Index elements_ = 0;
  std::optional<Parts> body_, whole_;
  detail::CutMotion<E>* cut_motion_ = nullptr;
  std::size_t known_ = 0;     // vertices of the set-up
  std::vector<int> similar_;  // per vertex
  Tools tools_;
  detail::CutOrders orders_;
  detail::RestingEdges edges_;
  std::shared_ptr<const SubfacetCompliance> half_space_;  // before any cut
  CutReport report_;
  std::atomic<bool> failed_{false};
  bool left_out_ = false;   // triangles of the surface, too large for the tools
  bool halted_ = false;     // the surface does not fit to the motion: no steps until a reset
  std::uint64_t seen_ = 0;  // number of the surface that the session uses
};

}}  // namespace palpate
