// Rigid balls against a deformable surface, solved exactly in every tick.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/complementarity.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_samples.hpp>
#include <palpate/core/setup_error.hpp>

#include <vector>

namespace palpate::inline PALPATE_ABI {

/// All contacts of all tools with one tissue. The surface is held off the ball at material points: vertices, and a
/// lattice on edges longer than `sample_spacing` radii. Points fixed in the material meet a sliding ball one after the
/// other, each with zero force at first, so the force has no jump at edges. Where edges are shorter than half the
/// radius the points are the vertices and the answer converges with the mesh; on coarser ones the flat facets cannot
/// hug the ball and the contact is too stiff (README.md has figures). Each tick linearises the distance
/// between ball and deformed surface at the last proxy position (Ruspini's proxy on a deforming surface), solves the
/// Signorini problem on the contact compliance J C J^T exactly, and repeats while the force still changes. The coupling
/// between proxy and device enters as n_i . n_j / k between contacts of one tool: the device never feels more than k,
/// however many contacts there are, and the proxy never sinks in. Work is bounded by `Capacity`, iterations and
/// candidates.
template <int Capacity = 48>
class ContactProblem {
 public:
  /// Places the contact points for balls of at least `smallest_radius` [m]. Allocates workspaces; for set-up.
  /// Throws bad_argument unless 0.4 <= sample_spacing <= 1 and there is at least one iteration.
  ContactProblem(const ContactSurface& surface, double smallest_radius, ContactParameters parameters = {})
      : parameters_(checked(parameters)),
        samples_(surface, parameters.sample_spacing * smallest_radius),
        displacement_(surface.positions().size()),
        stamp_(displacement_.size(), 0),
        number_(displacement_.size(), 0) {}

  /// Finds the forces for the tools' new targets; updates proxy and force of every active tool. Never allocates.
  template <TissueModel Tissue>
  Status solve(Tissue& tissue, std::span<ContactTool> tools) noexcept {
    Status status;
    for (int iteration = 0; iteration < parameters_.maximum_iterations; ++iteration) {
      status |= collect(tissue, tools);
      double change = 0.0, scale = 0.0;
      status |= solve_linearised(tissue, tools, change, scale);
      if (change <= parameters_.force_tolerance * scale) return status;
      if (iteration + 1 == parameters_.maximum_iterations && change > unsettled * scale)
        status.set(StatusFlag::solver_not_converged);
    }
    return status;
  }

  /// Forgets all contact forces, as when every tool was lifted.
  void clear() noexcept {
    contact_count_ = 0;
    force_count_ = 0;
  }

  /// Contacts of the last tick, those without force included.
  std::span<const Contact> contacts() const noexcept {
    return {contacts_.data(), static_cast<std::size_t>(contact_count_)};
  }
  /// The forces of the last tick on the vertices.
  std::span<const VertexForce> vertex_forces() const noexcept {
    return {forces_.data(), static_cast<std::size_t>(force_count_)};
  }

 private:
  template <TissueModel Tissue>
  const Vector3& displacement(const Tissue& tissue, int v) noexcept {
    const auto i = static_cast<std::size_t>(v);
    if (stamp_[i] != generation_) {
      stamp_[i] = generation_;
      displacement_[i].setZero();
      for (const VertexForce& f : vertex_forces())
        displacement_[i].noalias() += tissue.compliance(v, f.vertex) * f.force;
    }
    return displacement_[i];
  }

  /// Fills contacts_ with the points of the deformed surface near each proxy.
  template <TissueModel Tissue>
  Status collect(const Tissue& tissue, std::span<ContactTool> tools) noexcept {
    Status status;
    ++generation_;
    contact_count_ = 0;
    double reach = 0.0;
    for (const VertexForce& f : vertex_forces()) reach += tissue.compliance_bound(f.vertex) * f.force.norm();
    const ContactSurface& surface = tissue.contact_surface();
    for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
      const ContactTool& tool = tools[static_cast<std::size_t>(t)];
      if (!tool.active) continue;
      // Points this near may be reached while the linearisation settles; leaving one out lets the ball fall through it.
      const double margin = 0.25 * tool.radius + 1.5 * tool.motion;
      surface.bvh().visit_near(tool.proxy, tool.radius + margin + reach, [&](int triangle) {
        if (!add_candidates(tissue, tool, t, triangle, margin)) status.set(StatusFlag::degraded_model);
      });
    }
    return status;
  }

  /// Adds the samples of one triangle that are near and face the ball; false when a contact had to be dropped for lack
  /// of room.
  template <TissueModel Tissue>
  bool add_candidates(const Tissue& tissue, const ContactTool& tool, int t, int triangle, double margin) noexcept {
    const ContactSurface& surface = tissue.contact_surface();
    bool kept = true;
    for (const ContactSample& sample : samples_.of_triangle(triangle)) {
      Contact c;
      for (std::size_t a = 0; a < 3; ++a)
        if (sample.weights[a] > 0.0)
          c.point +=
              sample.weights[a] * (surface.position(sample.vertices[a]) + displacement(tissue, sample.vertices[a]));
      const Vector3 offset = tool.proxy - c.point;
      const double distance = offset.norm();
      c.gap = distance - tool.radius;
      if (!(c.gap <= margin && distance > 0.0) || !faces_ball(tissue, triangle, offset)) continue;
      c.tool = t;
      c.vertices = sample.vertices;
      c.weights = sample.weights;
      c.normal = offset / distance;
      for (std::size_t a = 0; a < 3; ++a) c.rest_offset += c.weights[a] * c.normal.dot(surface.position(c.vertices[a]));
      kept = keep(c) && kept;
    }
    return kept;
  }

  /// Whether the ball lies on the outer side of a triangle, as it rests or as it is deformed: in a steep dent only the
  /// latter holds. What the ball sees through a thin part from behind fails both.
  template <TissueModel Tissue>
  bool faces_ball(const Tissue& tissue, int triangle, const Vector3& offset) noexcept {
    const ContactSurface& surface = tissue.contact_surface();
    if (offset.dot(surface.normal(triangle)) > 0.0) return true;
    const Triangle& v = surface.triangle(triangle);
    const Vector3 x0 = surface.position(v[0]) + displacement(tissue, v[0]);
    const Vector3 x1 = surface.position(v[1]) + displacement(tissue, v[1]);
    const Vector3 x2 = surface.position(v[2]) + displacement(tissue, v[2]);
    return offset.dot((x1 - x0).cross(x2 - x0)) > 0.0;
  }

  bool keep(const Contact& c) noexcept {
    if (contact_count_ < Capacity) {
      contacts_[static_cast<std::size_t>(contact_count_++)] = c;
      return true;
    }
    const auto farthest = std::ranges::max_element(contacts_, {}, &Contact::gap);
    if (c.gap < farthest->gap) *farthest = c;
    return false;
  }

  /// One Signorini problem for the contacts found; updates forces, proxies and the change of the tools' forces.
  template <TissueModel Tissue>
  Status solve_linearised(Tissue& tissue, std::span<ContactTool> tools, double& change, double& scale) noexcept {
    Status status = number_vertices(tissue);
    build(tissue, tools);
    if (!problem_.solve()) status.set(StatusFlag::solver_not_converged);
    for (int i = 0; i < force_count_; ++i) forces_[static_cast<std::size_t>(i)].force.setZero();
    for (int i = 0; i < contact_count_; ++i) {
      Contact& c = contacts_[static_cast<std::size_t>(i)];
      c.force = problem_.lambda[i];
      for (std::size_t a = 0; a < 3; ++a)
        if (c.weights[a] > 0.0) forces_[local(i, a)].force -= (c.force * c.weights[a]) * c.normal;
    }
    const auto loaded = std::remove_if(forces_.begin(), forces_.begin() + force_count_,
                                       [](const VertexForce& f) { return f.force.isZero(0.0); });
    force_count_ = static_cast<int>(loaded - forces_.begin());
    for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
      ContactTool& tool = tools[static_cast<std::size_t>(t)];
      if (!tool.active) continue;
      Vector3 total = Vector3::Zero();
      for (const Contact& c : contacts())
        if (c.tool == t) total += c.force * c.normal;
      change = std::max(change, (total - tool.force).norm());
      scale = std::max(scale, total.norm());
      tool.force = total;
      // The next linearisation must stay within reach of the points this one knew.
      const Vector3 step = tool.target + coupling(tissue, tool) * total - tool.proxy;
      const double longest = 0.25 * tool.radius + tool.motion;
      tool.proxy += step.norm() <= longest ? step : Vector3((longest / step.norm()) * step);
    }
    return status;
  }

  /// Numbers the vertices that carry contacts and asks for their compliance columns.
  template <TissueModel Tissue>
  Status number_vertices(Tissue& tissue) noexcept {
    ++generation_;
    force_count_ = 0;
    for (int i = 0; i < contact_count_; ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        if (contacts_[static_cast<std::size_t>(i)].weights[a] == 0.0) continue;
        const int v = contacts_[static_cast<std::size_t>(i)].vertices[a];
        if (stamp_[static_cast<std::size_t>(v)] != generation_) {
          stamp_[static_cast<std::size_t>(v)] = generation_;
          number_[static_cast<std::size_t>(v)] = force_count_;
          vertices_[static_cast<std::size_t>(force_count_)] = v;
          forces_[static_cast<std::size_t>(force_count_++)] = {v, Vector3::Zero()};
        }
        local_[static_cast<std::size_t>(i)][a] = static_cast<std::size_t>(number_[static_cast<std::size_t>(v)]);
      }
    return tissue.require_columns({vertices_.data(), static_cast<std::size_t>(force_count_)});
  }

  /// W = J C J^T plus the coupling, b = gap at the target without contact force.
  template <TissueModel Tissue>
  void build(const Tissue& tissue, std::span<const ContactTool> tools) noexcept {
    problem_.resize(contact_count_);
    for (int i = 0; i < contact_count_; ++i) {
      const Contact& ci = contacts_[static_cast<std::size_t>(i)];
      const ContactTool& tool = tools[static_cast<std::size_t>(ci.tool)];
      problem_.b[i] = ci.normal.dot(tool.target) - ci.rest_offset - tool.radius;
      problem_.lambda[i] = ci.gap < 0.01 * tool.radius ? 1.0 : 0.0;  // touching now: likely touching still
      for (int j = 0; j <= i; ++j) {
        const Contact& cj = contacts_[static_cast<std::size_t>(j)];
        Vector3 response = Vector3::Zero();
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < 3; ++b)
            if (ci.weights[a] * cj.weights[b] > 0.0)
              response.noalias() +=
                  (ci.weights[a] * cj.weights[b]) * (tissue.compliance(ci.vertices[a], cj.vertices[b]) * cj.normal);
        double w = ci.normal.dot(response);
        if (ci.tool == cj.tool) w += coupling(tissue, tool) * ci.normal.dot(cj.normal);
        problem_.w(i, j) = problem_.w(j, i) = w;
      }
    }
  }

  template <TissueModel Tissue>
  static double coupling(const Tissue& tissue, const ContactTool& tool) noexcept {
    return tool.compliance + tissue.compliance_floor();
  }
  std::size_t local(int contact, std::size_t a) const noexcept { return local_[static_cast<std::size_t>(contact)][a]; }

  static ContactParameters checked(const ContactParameters& p) {
    if (!(p.sample_spacing >= 0.4 && p.sample_spacing <= 1.0))
      raise(SetupErrorKind::bad_argument, "the sample spacing is " + number(p.sample_spacing) + " radii",
            "Below 0.4 there is no room for all points under a ball, above 1 the ball falls between them");
    if (p.maximum_iterations < 1) raise(SetupErrorKind::bad_argument, "a tick needs at least one linearisation");
    return p;
  }

  static constexpr double unsettled =
      0.05;  // relative change of force in the last linearisation that is not kept quiet
  static constexpr auto capacity = static_cast<std::size_t>(Capacity);
  ContactParameters parameters_;
  ContactSamples samples_;
  ComplementarityProblem<Capacity> problem_;
  std::array<Contact, capacity> contacts_{};
  std::array<std::array<std::size_t, 3>, capacity> local_{};
  std::array<VertexForce, 3 * capacity> forces_{};
  std::array<int, 3 * capacity> vertices_{};
  int contact_count_ = 0;
  int force_count_ = 0;
  std::vector<Vector3> displacement_;  // of vertices looked at in this generation
  std::vector<std::uint64_t> stamp_;
  std::vector<int> number_;
  std::uint64_t generation_ = 0;
};

}  // namespace palpate::inline PALPATE_ABI
