// A body under cuts between two changes: its topology, compliance and contact surface.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/cut/cut_parameters.hpp>
#include <palpate/cut/detail/cut_half_space.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_preparation.hpp>
#include <palpate/cut/detail/cut_surface.hpp>
#include <palpate/cut/detail/cut_system.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/cut/detail/resting_nodes.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The state of a body that is cut, and the views of it for the tick. CutProcess changes it. Neither copied nor moved.
template <Element E>
class CutState {
 public:
  using Publish = std::function<void(CutView&&)>;

  CutState(const CutState&) = delete;
  CutState& operator=(const CutState&) = delete;

  /// Rebuilds the contact surface for these tools. Before the first cut, throws what require_dense_points throws;
  /// `loads` describes the scene's loads in its message. Strong guarantee.
  void set_tools(const ToolRadii& radii, const ContactParameters& parameters, const std::string& loads) {
    if (radii == tools_.radii && parameters.sample_spacing == tools_.contact.sample_spacing) return;
    const Tools before = std::exchange(tools_, {radii, parameters});
    const auto surface = contact_;
    ++cut_;
    const auto make = [&] {
      make_contact();
      if (contact_->left_out && report_.cuts == 0) require_dense_surface(radii.smallest, loads);
    };
    run_or_undo(make, [&] {
      tools_ = before;
      contact_ = surface;
    });
    publish_exactly();
  }

  /// Displacement of all nodes with forces on vertices, 3 per node [m].
  VectorX displacement_with(std::span<const VertexForce> forces) {
    require_vertex_forces(forces, static_cast<int>(touchable_.nodes().size()));
    std::vector<std::pair<NodeId, Vector3>> list;
    for (const VertexForce& f : forces)
      list.push_back({touchable_.nodes()[static_cast<std::size_t>(f.vertex)], f.force.in_model_axes()});
    VectorX u = system_.displacement_with(list);
    resting_.restore(u);
    return u;
  }

  const CutReport& report() const noexcept { return report_; }
  const CutTopology<E>& topology() const noexcept { return topology_; }
  const CutPhysics<E>& physics() const noexcept { return *physics_; }

 protected:
  /// Throws as factorisation.
  CutState(CutPreparation<E> prepared, const SetupLimits& limits, Publish publish, SetupReport& report)
      : physics_(std::make_unique<CutPhysics<E>>(std::move(prepared.physics))),
        topology_(std::move(prepared.topology)),
        touchable_(std::move(prepared.touchable)),
        cuttable_(std::move(prepared.cuttable)),
        limits_(limits),
        publish_to_(std::move(publish)),
        system_(topology_, *physics_, kept_nodes(), limits_, &report),
        diagonal_(box_of(topology_.mesh().positions).size().norm()),
        lost_(std::max(report.probe_error, 0.5 * std::numeric_limits<double>::epsilon() * report.condition_estimate)) {
    half_space_ = half_space_before_cuts();
    limits_.threads = 1;  // beside a haptic loop from here on
    limits_.progress = {};
    find_supports();
    report_.kept = system_.kept();
    const StageTimer timer(report, "contact");
    make_contact();
    publish_exactly();
  }
  ~CutState() = default;

  /// The tools that the contact surface is made for. Radius 0, before the first session: a tool large enough that no
  /// triangle is left out.
  struct Tools {
    ToolRadii radii = 0.0;
    ContactParameters contact{};
  };
  std::vector<NodeId> kept_nodes() const {
    std::vector<NodeId> nodes;
    for (std::size_t v = 0; v < touchable_.nodes().size(); ++v)
      if (touchable_.is_used(v)) nodes.push_back(touchable_.nodes()[v]);
    for (NodeId node = 0; node < topology_.mesh().node_count(); ++node)
      if (std::ranges::binary_search(cuttable_, topology_.origin_of(node))) nodes.push_back(node);
    sort_unique(nodes);
    return nodes;
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
  /// Parts that touch only at nodes or edges have copies of these from the start: they have what the node has.
  std::shared_ptr<const SubfacetCompliance> half_space_before_cuts() const {
    const Body<E>& whole = physics_->body;
    std::vector<NodeId> touched;
    for (const NodeId node : touchable_.nodes())
      if (topology_.origin_of(node) == node) touched.push_back(node);
    const std::span<const std::uint8_t> constrained = topology_.constrained();
    return std::make_shared<SubfacetCompliance>(project_half_space(whole, extract_boundary<E>(whole.mesh), touched,
                                                                   constrained.first(whole.mesh.positions.size()),
                                                                   nullptr, limits_));
  }
  /// Finds how far the nodes that may be touched are from a constrained one, in the body before any cut.
  void find_supports() {
    std::vector<Vector3> constrained;
    for (NodeId node = 0; node < topology_.mesh().node_count(); ++node)
      if (topology_.constrained()[static_cast<std::size_t>(node)] != 0)
        constrained.push_back(topology_.mesh().position(node));
    support_.assign(static_cast<std::size_t>(topology_.mesh().node_count()), infinity);
    for (const NodeId node : kept_nodes()) {
      double square = infinity;
      for (const Vector3& p : constrained)
        square = std::min(square, (p - topology_.mesh().position(node)).squaredNorm());
      support_[static_cast<std::size_t>(topology_.origin_of(node))] = std::sqrt(square);
    }
    size_ = box_of(topology_.mesh().positions).size().maxCoeff();
  }
  /// The error of the compliance is that of the factor, or the last one that was measured after a cut.
  LinearModelError model_error(const std::vector<double>& bounds) const {
    LinearModelError error;
    const double lost = std::max(lost_, report_.error);
    for (const double bound : bounds) error.conditioning = std::max(error.conditioning, lost * bound);
    error.body_size = size_;
    for (const NodeId node : touchable_.nodes())
      error.supports.push_back(support_[static_cast<std::size_t>(topology_.origin_of(node))]);
    return error;
  }
  std::vector<Vector3> positions_of(const std::vector<NodeId>& nodes) const {
    std::vector<Vector3> positions;
    for (const NodeId node : nodes) positions.push_back(position(node));
    return positions;
  }
  /// With the materials behind its triangles, and the boundary that cannot be touched. Nodes there that are not kept
  /// have the displacement before the last cut.
  ContactSurface make_surface(std::vector<Vector3> positions, double smallest_radius) const {
    std::vector<Triangle> triangles = touchable_.triangles();
    std::vector<Index> elements = touchable_.elements();
    for (Index& e : elements) e = topology_.origin_of_element(e);
    erase_stretched(positions, ContactSamples::maximum_subdivision * smallest_radius, triangles, elements);
    ContactSurface surface(std::move(positions), std::move(triangles));
    surface.set_materials(contact_materials(physics_->body, elements));
    surface.set_subfacet(half_space_after_cuts(half_space_, topology_, touchable_.nodes()));
    const auto shell = touchable_.shell(topology_);
    surface.add_shell(positions_of(shell.others), shell.triangles);
    return surface;
  }
  void make_contact() {
    std::vector<Vector3> positions = positions_of(touchable_.nodes());
    const ToolRadii radii = tools_.radii.smallest > 0.0 ? tools_.radii : ToolRadii(longest_edge(positions));
    report_.displacement = displacement_spread(displacements_to(positions)) / diagonal_;
    ContactSurface surface = make_surface(std::move(positions), radii.smallest);
    contact_ = std::make_shared<CutContact>(system_, touchable_, std::move(surface), radii, tools_.contact, cut_);
    contact_->too_far = !(report_.displacement <= largest_linear_displacement);
  }
  void publish_exactly() {
    CutView made{contact_, system_.folded_step()};
    made.bound_exactly();
    publish(std::move(made));
  }
  /// The surface of a new contact gets its errors before a tick reads it.
  void publish(CutView&& made) {
    CutContact& contact = *made.contact;
    if (!contact.published) contact.surface.set_model_error(model_error(made.bound));
    bound_ = made.bound;
    contact.published = true;
    publish_to_(std::move(made));
  }

  std::unique_ptr<CutPhysics<E>> physics_;
  CutTopology<E> topology_;
  CutSurface<E> touchable_;
  std::vector<NodeId> cuttable_;  // sorted, node ids of the given mesh
  SetupLimits limits_;
  Tools tools_;
  Publish publish_to_;
  CutSystem<E> system_;
  RestingNodes resting_;
  double diagonal_, size_ = 0.0;  // of the bounding box, and its longest edge [m]
  double lost_;                   // relative error of the compliance at set-up
  std::vector<double> support_;   // per node before any cut, distance to a constrained one [m]; infinity: not touched
  CutReport report_;
  std::shared_ptr<const SubfacetCompliance> half_space_;  // before any cut
  std::shared_ptr<CutContact> contact_;                   // of the last cut
  std::vector<double> bound_;                             // of the last view
  std::uint64_t cut_ = 0;                                 // number of the last cut
};

}}}  // namespace palpate::detail
