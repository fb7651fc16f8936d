// Definitions of contact_problem.hpp.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/detail/deformed_surface.hpp>
#include <palpate/contact/detail/candidates.ipp>  // its inline functions
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ContactProblem::ContactProblem(const ContactSurface& surface, const ToolRadii& radii,
                                              const ContactParameters& parameters)
    : parameters_(checked(parameters.for_tools(1, surface.has_large_strain()))),
      displacement_(surface.vertex_count(), vertices_per_contact * parameters_.capacity),
      start_(surface.vertex_count(), vertices_per_contact * parameters_.capacity, 1),
      candidates_(made_samples(surface, radii, parameters_),
                  parameters_.subfacet_compliance ? surface.subfacet() : nullptr, parameters_.capacity),
      rows_(surface.vertex_count(), parameters_.friction, parameters_.capacity),
      pressing_(at(parameters_.capacity)),
      violated_(at(candidates_.maximum())) {
  on_points_.reserve(at(parameters_.capacity));
  detail::require_dense_points(surface, radii.smallest);
}

PALPATE_INLINE std::span<const PointForce> ContactProblem::point_forces() noexcept {
  on_points_.clear();
  for (const Contact& c : rows_.contacts())
    if (const Vector3 total = c.total(); total.squaredNorm() > 0.0)
      on_points_.push_back({c.vertices, c.weights, ModelVector(-total), c.grasped});
  return on_points_;
}

PALPATE_INLINE ContactParameters ContactProblem::checked(const ContactParameters& p) {
  if (!(p.sample_spacing >= 0.4 && p.sample_spacing <= 1.0))
    raise(SetupErrorKind::bad_argument, "the sample spacing is " + number(p.sample_spacing) + " radii",
          "Below 0.4 the points under a sphere exceed the capacity, above 1 the sphere falls between them");
  if (!(p.friction >= 0.0 && p.friction <= 4.0))
    raise(SetupErrorKind::bad_argument, "the coefficient of friction is " + number(p.friction), "Give 0 to 4");
  if (!(p.grasp_radius >= 0.0 && p.grasp_radius < infinity))
    raise(SetupErrorKind::bad_argument, "the radius of a grasp is " + number(p.grasp_radius) + " m",
          "Give the size of the tool's jaws, or 0 for one point");
  if (p.maximum_iterations < 1) raise(SetupErrorKind::bad_argument, "a tick needs at least one linearisation");
  if (p.capacity < 1 || p.capacity > maximum_capacity)
    raise(SetupErrorKind::bad_argument, "the capacity of a contact problem is " + std::to_string(p.capacity),
          "Give 1 to " + std::to_string(maximum_capacity) + " contacts; 64 is typical");
  return p;
}

inline bool ContactProblem::is_grasped(const ContactSurface& surface, const detail::Candidate& c) const noexcept {
  return grasps_[at(c.tool)].holds(surface, candidates_, c);
}

/// Fine enough for the first touch of the smallest tool; coarse enough for the largest at depths about its radius.
PALPATE_INLINE detail::ContactSamples ContactProblem::made_samples(const ContactSurface& surface,
                                                                   const ToolRadii& radii, const ContactParameters& p) {
  if (p.subfacet_compliance && surface.subfacet() != nullptr)
    return {surface, detail::PointLevels::finest_spacing * radii.smallest,
            detail::PointLevels::crowded_spacing * radii.largest_scale};
  const double finest = p.sample_spacing * radii.smallest;
  return {surface, finest, std::max(finest, detail::PointLevels::coarsest_of_mesh * radii.largest)};
}

/// Whether tools have contact points near them.
inline std::array<bool, maximum_tools> ContactProblem::are_near(Tools tools) const noexcept {
  std::array<bool, maximum_tools> is_near{};
  for (std::size_t t = 0; t < tools.size(); ++t)
    is_near[t] = tools[t].active && candidates_.has_any(static_cast<int>(t));
  return is_near;
}

/// Divides the rows among these tools.
PALPATE_INLINE void ContactProblem::share_rows(Tools tools, const std::array<bool, maximum_tools>& is_near) noexcept {
  std::array<detail::PointLevels::Size, maximum_tools> sizes{};
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active) sizes[t] = {tools[t].radius, tools[t].point_scale()};
  levels_.begin_tick(candidates_.samples(), sizes, is_near,
                     {rows_.capacity(), parameters_.pressing_points, candidates_.subfacet() != nullptr});
}

/// Tools that did not press yet get the level for the part of the surface that they have entered.
PALPATE_INLINE void ContactProblem::start_levels(const TissueView& tissue, Tools tools) noexcept {
  constexpr double pressing = 0.5;  // part of the surface entered that presses, in Hertz's theory
  std::array<bool, maximum_tools> begins{};
  std::array<double, maximum_tools> area{};
  for (std::size_t t = 0; t < tools.size(); ++t) begins[t] = tools[t].active && rows_.pressing_force(t) == 0.0;
  if (std::none_of(begins.begin(), begins.end(), [](bool b) { return b; })) return;
  for (detail::Candidate& c : candidates_.items()) {
    if (!begins[at(c.tool)] || candidates_.least_gap(c) > 0.0) continue;
    if (candidates_.is_stale(c)) {
      if (candidates_.raise_least_gap(tissue, tools[at(c.tool)], displacement_, c) > 0.0) continue;
      candidates_.evaluate(tissue, tools[at(c.tool)], displacement_, c);
    }
    if (c.facing && c.gap < 0.0)
      area[at(c.tool)] += pressing * candidates_.samples().area(c.sample, levels_.level(c.tool));
  }
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (begins[t]) levels_.start(candidates_.samples(), static_cast<int>(t), area[t]);
}

/// Per tool the number of vertices in the part of the surface that it presses, where strains are large. A vertex has
/// the area of two facets.
inline std::array<double, maximum_tools> ContactProblem::vertices_of_print(
    const ContactSurface& surface) const noexcept {
  std::array<double, maximum_tools> vertices{};
  const SubfacetCompliance* const rest = candidates_.subfacet();
  if (!surface.has_large_strain() || rest == nullptr) return vertices;
  for (int i = 0; i < static_cast<int>(rows_.contacts().size()); ++i) {
    const detail::Candidate& c = rows_.candidate(i);
    const Triangle& t = surface.triangle(c.triangle);
    if (!(c.force > 0.0) || c.grasped || !std::all_of(t.begin(), t.end(), [&](int v) { return rest->has_place(v); }))
      continue;
    const Vector3& x = rest->vertex(t[0]).position;
    vertices[at(c.tool)] += c.area / cross(rest->vertex(t[1]).position - x, rest->vertex(t[2]).position - x).norm();
  }
  return vertices;
}

/// A grasped point keeps the area that it had when it was grasped: its force does not change then.
inline void ContactProblem::set_area(detail::Candidate& c) const noexcept {
  if (!c.grasped) c.area = candidates_.samples().area(c.sample, levels_.level(c.tool));
}

inline bool ContactProblem::may_have_row(const detail::Candidate& c) const noexcept {
  return candidates_.samples().level_of(c.sample) >= levels_.first(c.tool);
}

/// Of a tool with more pressing points than its share, those of its level with the largest forces are kept.
inline void ContactProblem::note_pressing(detail::Candidate& c) noexcept {
  c.row = -1;
  if (c.grasped || !(c.force > 0.0)) return;
  if (!may_have_row(c)) return c.lift();
  int& own = pressing_of_[at(c.tool)];
  if (own < levels_.share(c.tool) && pressing_count_ < rows_.capacity()) {
    ++own;
    pressing_[at(pressing_count_++)] = &c;
    return;
  }
  detail::Candidate** weakest = nullptr;
  for (int i = 0; i < pressing_count_; ++i) {
    detail::Candidate*& other = pressing_[at(i)];
    if (other->tool == c.tool && other->force < (weakest == nullptr ? c : **weakest).force) weakest = &other;
  }
  if (weakest == nullptr) return c.lift();
  (*weakest)->lift();
  *weakest = &c;
}

inline void ContactProblem::set_levels(Tools tools) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) candidates_.set_level(t, levels_.known(static_cast<int>(t)));
}

/// Where the list has no room for all points near the tools, the tool with the most of them gets a higher level: at
/// once where it does not press, and the list is built again; otherwise in the next ticks.
PALPATE_INLINE Status ContactProblem::update_candidates(const TissueView& tissue, Tools tools) noexcept {
  constexpr int most_builds = 4;
  Status status = candidates_.update(tissue, tools, displacement_);
  if (!candidates_.is_new() && !status.has(StatusFlag::degraded_model)) return status;
  for (int build = 1;; ++build) {
    int most = 0, largest = -1;
    bool is_complete = true;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      const int tool = static_cast<int>(t), points = tools[t].active ? candidates_.count(tool) : 0;
      is_complete = is_complete && (!tools[t].active || candidates_.is_complete(t, tools[t]));
      if (points > most && !levels_.is_coarsest(tool)) most = points, largest = tool;
      levels_.note_room(tool, points, candidates_.room());
    }
    if (is_complete || largest < 0 || !levels_.note_full_list(largest) || build == most_builds) return status;
    set_levels(tools);
    status = candidates_.update_again(tissue, tools, displacement_);
  }
}

PALPATE_INLINE Status ContactProblem::solve(const TissueView& tissue, std::span<ContactTool> tools) noexcept {
  Status status = begin(tissue, tools);
  status |= iterate(tissue, tools);
  return status | end(tissue, tools);
}

PALPATE_INLINE Status ContactProblem::begin(const TissueView& tissue, std::span<ContactTool> tools) noexcept {
  floor_ = tissue.compliance_floor();
  late_ = false;
  Status status = tissue.require_columns({});  // before the revision is read
  note_forces_of_lifted(tools);
  set_outward(tissue.contact_surface(), tools);
  rows_.begin_tick(tissue.compliance_revision());
  displacement_.begin_tick(tissue.compliance_revision());
  detail::ProxyMotion::slide(tools);
  if (candidates_.begin_tick(tissue.contact_surface(), tools)) {
    displacement_.forget();
    start_.forget();
  }
  is_near_ = are_near(tools);
  share_rows(tools, is_near_);
  set_levels(tools);
  if (std::exchange(has_new_surface_, false)) {
    if (tissue.gains_pieces())  // a tool may grasp one of them in the tissue that it was cut off
      for (Grasp& g : grasps_) g.requested = g.holds_any();
    status |= balance(tissue, tools);
  }
  candidates_.look_round(tissue, tools, displacement_);
  candidates_.prepare(tissue, tools, displacement_);
  return status;
}

PALPATE_INLINE Status ContactProblem::iterate(const TissueView& tissue, std::span<ContactTool> tools,
                                              int linearisations) noexcept {
  Status status;
  rounds_left_ = maximum_rounds;
  double change = 0.0, before = 0.0;
  rest_of_change_ = 0.0;
  for (int iteration = 0; iteration < linearisations; ++iteration) {
    if (rounds_left_ <= 0) {
      status.set(StatusFlag::solver_not_converged);
      break;
    }
    proxies_.begin(tools, floor_);
    status |= update_candidates(tissue, tools);
    if (const auto now = are_near(tools); now != is_near_) share_rows(tools, is_near_ = now);
    if (iteration == 0) {
      start_levels(tissue, tools);
      status |= grasp(tissue, tools);
    }
    if (candidates_.is_new()) prefetch(tissue);
    std::swap(start_, displacement_);
    solve_linearised(tissue, tools, iteration, status);
    follow(tissue, tools);
    proxies_.end(tools);
    change = proxies_.relative_change(tools, rows_.largest_force_scale(tools));
    const bool converged = has_converged(tools, iteration, before, change);
    rest_of_change_ = converged ? change : rest_of_changes(iteration > 1 ? before : infinity, change, rest_of_change_);
    limit_feedback(converged, iteration > 0 && change > before);
    if (converged) break;
    before = change;
  }
  return status;
}

PALPATE_INLINE Status ContactProblem::end(const TissueView& tissue, std::span<ContactTool> tools) noexcept {
  Status status;
  rows_.stick(tools);
  std::array<int, maximum_tools> grasped{};
  for (std::size_t t = 0; t < maximum_tools; ++t) grasped[t] = static_cast<int>(grasps_[t].rows().size());
  levels_.end_tick(rows_.count_pressing(), rows_.points_of_print(), grasped,
                   vertices_of_print(tissue.contact_surface()));
  constexpr double allowed_in_rigid = 0.01;  // rows at a few points keep all of a facet out that cannot bend
  if (missing_depth() > (tissue.contact_surface().is_rigid() ? allowed_in_rigid : 0.0))
    status.set(StatusFlag::degraded_model);
  if (rest_of_change_ > unconverged_change || !rows_.has_converged() ||
      of_lifted_ > parameters_.force_tolerance * std::max(most_of_lifted_, rows_.largest_force_scale(tools)))
    status.set(StatusFlag::solver_not_converged);
  bool presses = rows_.deepest_push() > 0.0;
  for (const Grasp& g : grasps_) presses = presses || g.holds_any();
  if (proxies_.end_tick(tools, rest_of_change_ <= unconverged_change, presses, rows_.largest_force_scale(tools)))
    status.set(StatusFlag::solver_not_converged);
  return status;
}

/// The direction is the mean normal of the contacts while the centre is above all of them. A sphere between two parts
/// that push against each other came from neither. It has entered material that faces that direction at rest, not a
/// wall beside it.
PALPATE_INLINE void ContactProblem::set_outward(const ContactSurface& surface, Tools tools) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    ContactTool& tool = tools[t];
    if (tool.hull != nullptr) continue;
    // Without force also where it restarts elsewhere. A tool that grasps is drawn through the tissue around it.
    if (tool.force.squaredNorm() == 0.0 || is_holding(t)) {
      tool.outward.setZero();
      tool.entered = -infinity;
      continue;
    }
    const auto presses = [&](const Contact& c) { return c.tool == static_cast<int>(t) && !c.grasped && c.force > 0.0; };
    constexpr double common = 0.25;  // part of the forces
    Vector3 sum = Vector3::Zero();
    double all = 0.0;
    for (const Contact& c : rows_.contacts())
      if (presses(c)) sum += c.force * c.normal, all += c.force;
    if (all == 0.0) continue;  // the surface was cut
    const bool is_shallow = tool.outward.squaredNorm() == 0.0 || !tool.has_cone();
    if (is_shallow) tool.outward = sum.norm() > common * all ? sum.normalized() : Vector3(0.0, 0.0, 0.0);
    if (!tool.may_have_cone(tool.outward)) tool.outward.setZero();
    tool.entered = -infinity;
    constexpr double facing = 0.8;  // 37 degrees: not two walls of a corner
    for (int i = 0; i < rows_.count(); ++i) {
      const Contact& c = rows_.contacts()[at(i)];
      if (presses(c) && surface.normal(rows_.candidate(i).triangle).dot(tool.outward) > facing)
        tool.entered = std::max(tool.entered, tool.height(c.rest));
    }
  }
}

/// Adds up the forces that are still on the tissue although their tools are gone or restart elsewhere. While a
/// linearisation takes only a part of its step, a part of these forces stays.
PALPATE_INLINE void ContactProblem::note_forces_of_lifted(Tools tools) noexcept {
  for (const Contact& c : rows_.contacts())
    if (tools[at(c.tool)].force.squaredNorm() == 0.0) of_lifted_ += c.total().norm();
  most_of_lifted_ = of_lifted_ > 0.0 ? std::max(most_of_lifted_, of_lifted_) : 0.0;
}

/// What may be missing from a force that has not converged: at least its last change, `change`. Changes that get
/// smaller by the same ratio are a geometric series. Where one grows and is not small, the tool leaves an equilibrium
/// that is not stable: rounding decides how far it gets in this tick. `rest` is that of the linearisation before.
PALPATE_INLINE double ContactProblem::rest_of_changes(double before, double change, double rest) noexcept {
  if (rest == infinity || (change >= before && change > growing)) return infinity;
  return change < before ? std::max(change, change * change / (before - change)) : change;
}

/// Whether the expected change by further linearisations is within the tolerance. `change` is that of the last one,
/// `before` that of the one before it. Where the estimate of the next change ends the tick, `change` becomes that
/// estimate.
PALPATE_INLINE bool ContactProblem::has_converged(Tools tools, int iteration, double before, double& change) noexcept {
  if (!arrived_ || candidates_.has_lost_forces()) return false;
  // Each step is smaller than the last by about the same ratio (the linearisation neglects the curvature of the
  // sphere), so the sum of the remaining steps is a geometric series. The first step is due to the motion of the
  // device, so the second gives no ratio yet.
  const double expected = iteration == 0                     ? first_change_safety * change
                          : iteration > 1 && change < before ? change * change / (before - change)
                                                             : change;
  if (expected <= parameters_.force_tolerance) return true;
  if (iteration > 0) return false;
  // The first step is long when the device moves, but it was linearised close to where the tool arrives.
  const double estimate = estimate_safety * rows_.remaining_change(tools);
  if (!(estimate <= parameters_.force_tolerance)) return false;
  change = estimate;
  return true;
}

PALPATE_INLINE double ContactProblem::missing_depth() const noexcept {
  return levels_.deepest() > 0.0 ? levels_.deepest() / std::max(levels_.deepest(), rows_.deepest_push()) : 0.0;
}

/// Whether a tool presses the point of a row, and does not hold it.
PALPATE_INLINE bool ContactProblem::presses(std::size_t t, int row) const noexcept {
  const detail::Candidate& c = rows_.candidate(row);
  return c.tool == static_cast<int>(t) && !c.grasped && c.force > 0.0;
}

PALPATE_INLINE double ContactProblem::force_on_rim(const TissueView& tissue, std::size_t t) const noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  if (!surface.has_shell()) return 0.0;
  double all = 0.0, on_rim = 0.0;
  for (int row = 0; row < rows_.count(); ++row) {
    if (!presses(t, row)) continue;
    const detail::Candidate& point = rows_.candidate(row);
    const Contact& c = rows_.contacts()[at(row)];
    all += c.force;
    double beside = 1.0;  // weights of vertices that are not on the rim
    for (std::size_t a = 0; a < 3; ++a)
      if (c.weights[a] > 0.0 && surface.goes_on(c.vertices[a], c.normal)) beside -= c.weights[a];
    const double length = surface.facet_length(point.triangle),
                 spacing = rows_.has_area(row) ? std::sqrt(point.area) : 0.0;
    if (beside < 1.0 && beside * length <= std::max(1e-9 * length, 0.5 * spacing)) on_rim += c.force;
  }
  return all > 0.0 ? on_rim / all : 0.0;
}

/// Mean depth of contacts with that force and push work, weighted with their forces, without the coupling.
PALPATE_INLINE double ContactProblem::depth_of(double work, double scale, const Vector3& force,
                                               const ContactTool& tool) const noexcept {
  return scale > 0.0 ? std::max(0.0, (work - tool.compliance * force.dot(tool.force)) / scale) : 0.0;
}

PALPATE_INLINE double ContactProblem::indentation(std::size_t t, const ContactTool& tool) const noexcept {
  return depth_of(rows_.push_work(static_cast<int>(t)), scale_of_force(t, tool.force.norm()), tool.force, tool);
}

PALPATE_INLINE double ContactProblem::force_from_behind(const TissueView& tissue, std::size_t t) noexcept {
  double all = 0.0, behind = 0.0;
  for (int row = 0; row < rows_.count(); ++row) {
    if (!presses(t, row)) continue;
    const detail::Candidate& c = rows_.candidate(row);
    all += c.force;
    if (!candidates_.faces_sphere(tissue, displacement_, c)) behind += c.force;
  }
  return all > 0.0 ? behind / all : 0.0;
}

/// Distance of a contact point from the nearest constrained node, interpolated from its vertices [m].
inline double ContactProblem::distance_from_support(const detail::LinearModelError& model, const Contact& c) noexcept {
  double distance = 0.0;
  for (std::size_t a = 0; a < 3; ++a) distance += c.weights[a] * model.supports[at(c.vertices[a])];
  return distance;
}

/// The strain follows from the force on a fine mesh. Where columns, rows or points are missing the force may be too
/// small: all of the depth then counts as indentation.
PALPATE_INLINE void ContactProblem::add_model_errors(const ContactSurface& surface, std::size_t t,
                                                     detail::SphereIndentation sphere, double scale,
                                                     ForceErrorParts& parts) const noexcept {
  const detail::LinearModelError& model = surface.model_error();
  if (!(sphere.depth > 0.0 && model.body_size > 0.0)) return;
  const bool is_sparse = has_fewer_points(t) && error_of_points(t) > flagged_error;
  if (late_ || missing_depth() > 0.0 || is_sparse) sphere.force = infinity;
  double sum = 0.0;
  for (const Contact& c : rows_.contacts()) {
    if (c.tool != static_cast<int>(t) || c.force == 0.0) continue;
    if (sum == 0.0) {
      const ContactMaterial material = surface.material(surface.triangles_at(c.vertices[0]).front());
      if (material.modulus > 0.0) {
        sphere.modulus = material.modulus;
        sphere.poisson_ratio = material.poisson_ratio;
      }
    }
    // At a fixed point the support carries the force, and no tissue is strained.
    if (const double support = distance_from_support(model, c); support > 0.0)
      sphere.support = std::min(sphere.support, support);
    sum += std::abs(c.force) + c.friction.norm();
  }
  parts.storage += model.storage * sum * sum / sphere.depth;
  parts.conditioning += model.conditioning * sum * sum / sphere.depth;
  sphere.depth += levels_.deepest();  // points without rows sink in
  parts.linearity += scale * detail::linearity_error(sphere, model.body_size);
}

/// Whether the force is more than a tenth too large because a thin body has too few elements across it to bend. Their
/// error counts for the part of the depth that is not the dent of the tool: that of Hertz for a sphere, for other tools
/// about that of a disc with the area of the points. O(rows).
PALPATE_INLINE bool ContactProblem::bends_coarse_elements(const ContactSurface& surface, std::size_t t,
                                                          const ContactTool& tool) const noexcept {
  double all = 0.0, error = 0.0, area = 0.0, modulus = 0.0;
  for (int row = 0; row < rows_.count(); ++row) {
    if (!presses(t, row)) continue;
    const detail::Candidate& c = rows_.candidate(row);
    all += c.force;
    area += c.area;
    if (const double own = rows_.bending_error(row); own > 0.0) {
      error += own * c.force;
      modulus = surface.material(c.triangle).modulus;
    }
  }
  if (!(error > flagged_error * all && modulus > 0.0)) return false;
  const double depth = indentation(t, tool), force = tool.force.norm();
  const bool is_sphere = tool.half_length == 0.0 && tool.hull == nullptr;
  constexpr double disc = 1.6;  // between a sphere, 4/3, and a flat stamp, 2
  const double dent = is_sphere ? std::cbrt(std::pow(0.75 * force / modulus, 2) / tool.radius)
                                : force / (disc * modulus * std::sqrt(area * std::numbers::inv_pi));
  return error * (depth - dent) > flagged_error * all * depth;
}

/// Whether a part of the force is too near to a sharp edge, on facets longer than `longest`.
PALPATE_INLINE bool ContactProblem::presses_edge(const ContactSurface& surface, std::size_t t,
                                                 double longest) const noexcept {
  constexpr double part = 0.3;
  double all = 0.0, at_edge = 0.0;
  for (int row = 0; row < rows_.count(); ++row) {
    if (!presses(t, row)) continue;
    const detail::Candidate& c = rows_.candidate(row);
    all += c.force;
    if (rows_.edge_nearness(row) > 1.0 && surface.facet_length(c.triangle) > longest) at_edge += c.force;
  }
  return at_edge > part * all;
}

/// Whether a part of the force is at points where the body is no half-space, or that have only the compliance of the
/// mesh, on facets that are too long: for the dent of the tool, or, where no error was measured, for the radius of the
/// contact; or there at a sharp edge; or at points that are too far apart for the thickness of the body; or at one or
/// two points, on facets so long that they have no more; or, in a deep press at large strain, on facets that are long
/// for the tool: they do not show how the surface stretches.
PALPATE_INLINE bool ContactProblem::presses_coarse_facets(const ContactSurface& surface, std::size_t t,
                                                          const ContactTool& tool, bool measured) const noexcept {
  constexpr double coarse = 0.6, long_facet = 0.75, usual_depth = 0.125;
  constexpr double deep = 0.4, long_for_deep = 0.65;  // radii
  const double depth = std::max(indentation(t, tool), usual_depth * tool.radius);
  constexpr double very_long =
      detail::ContactSamples::maximum_subdivision * 2.0 * detail::PointLevels::finest_spacing;  // radii
  double longest = tool.radius / coarse;
  const bool is_deep = surface.has_large_strain() && depth > deep * tool.radius;
  const double shown = is_deep ? deep * tool.radius : depth;  // a deeper dent does not allow longer facets
  if (!measured && tool.hull == nullptr) longest = std::min(longest, long_facet * std::sqrt(tool.radius * shown));
  const double longest_stretched = is_deep ? long_for_deep * tool.point_scale() : infinity;
  double all = 0.0, on_coarse = 0.0, on_very_long = 0.0;
  int points = 0;  // with an area
  for (int row = 0; row < rows_.count(); ++row) {
    if (!presses(t, row)) continue;
    const detail::Candidate& c = rows_.candidate(row);
    all += c.force;
    points += rows_.has_area(row);
    const auto is_longer = [fourth_power = surface.double_area_squared(c.triangle)](double length) {
      return fourth_power > length * length * length * length;
    };
    if (rows_.is_on_thin_body(row) || is_longer(longest_stretched) || (!rows_.is_known(row) && is_longer(longest)))
      on_coarse += c.force;
    else if (is_longer(very_long * tool.radius))
      on_very_long += c.force;
  }
  if (points == 1 || points == 2) on_coarse += on_very_long;
  return on_coarse > flagged_part * all || presses_edge(surface, t, tool.hull == nullptr ? longest : 0.0);
}

/// The part of the force by which a contact of few points may be wrong: measured with spheres on meshes whose nodes
/// were renumbered, which have other points, and with few rows: up to 3 / n^2 for the points of the print
/// (ContactRows::points_of_print). Points without half-space have no area, and stand for themselves.
PALPATE_INLINE double ContactProblem::error_of_points(std::size_t t) const noexcept {
  constexpr double factor = 4.0;
  bool has_areas = false;
  for (int i = 0; i < rows_.count() && !has_areas; ++i)
    has_areas = rows_.candidate(i).tool == static_cast<int>(t) && rows_.has_area(i);
  const double points = has_areas ? rows_.points_of_print()[t] : 0.0;
  return points > 0.0 ? std::min(1.0, factor / (points * points)) : 0.0;
}

/// For tools of other shapes nothing is measured. Where the error of a sphere of the same radius, pressed as deep, is
/// large, theirs is: its force there is that on a half-space. Relative to the force; infinite if not known.
PALPATE_INLINE double ContactProblem::error_of_sphere(const ContactSurface& surface, const ForceAccuracy& accuracy,
                                                      std::size_t t, const ContactTool& tool) const noexcept {
  const auto rows = rows_.contacts();
  const Contact* own = nullptr;
  for (const Contact& c : rows)
    if (own == nullptr && c.tool == static_cast<int>(t)) own = &c;
  if (own == nullptr) return infinity;
  const double modulus = surface.material(surface.triangles_at(own->vertices[0]).front()).modulus;
  const double depth = std::min(indentation(t, tool), tool.radius),
               force = 4.0 / 3.0 * modulus * std::sqrt(tool.radius * depth) * depth;
  ContactTool sphere = tool;
  sphere.half_length = 0.0;
  sphere.force = Vector3(0.0, 0.0, force);
  const double bound = accuracy.error(sphere, static_cast<int>(t), rows, depth).bound;
  return bound > 0.0 ? bound / force : 0.0;
}

/// Whether points have the compliance with which errors are measured at set-up.
PALPATE_INLINE bool ContactProblem::is_as_measured(const ContactSurface& surface) const noexcept {
  return candidates_.subfacet() != nullptr || surface.subfacet() == nullptr;
}

/// Whether more than a tenth of the force is at points beside a pad: they have another compliance than was measured.
PALPATE_INLINE bool ContactProblem::presses_beside_pad(std::size_t t) const noexcept {
  constexpr double most = 0.1;
  double all = 0.0, beside = 0.0;
  for (const Contact& c : rows_.contacts())
    if (c.tool == static_cast<int>(t) && !c.grasped && c.force > 0.0) {
      all += c.force;
      if (candidates_.depends_on_pad({c.vertices, c.weights})) beside += c.force;
    }
  return beside > most * all;
}

/// The errors that were measured on a surface, where they are those of the tissue's contact; else null.
PALPATE_INLINE const ForceAccuracy* ContactProblem::accuracy_of(const TissueView& tissue) const noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  return tissue.has_contact_materials() && is_as_measured(surface) ? surface.force_accuracy() : nullptr;
}

/// A sphere without force may have entered a facet between contact points.
PALPATE_INLINE ForceError ContactProblem::error_without_force(const TissueView& tissue,
                                                              const ContactTool& tool) const noexcept {
  const ForceError unknown{0.0, infinity, 0.0}, none{0.0, 0.0, 0.0, {0.0}};
  const ContactSurface& surface = tissue.contact_surface();
  const ForceAccuracy* const accuracy = accuracy_of(tissue);
  if (accuracy == nullptr) return unknown;
  const auto closest = surface.closest(tool.proxy);
  return closest.distance < tool.radius ? accuracy->error_without_force(surface.triangle(closest.triangle)[0]) : none;
}

/// The bounds add up. The expected error counts as far as it is along the force of the tool.
PALPATE_INLINE ForceError ContactProblem::force_error(const TissueView& tissue, std::size_t t,
                                                      const ContactTool& tool) noexcept {
  coarse_[t] = false;
  if (!tool.active || !candidates_.has_any(static_cast<int>(t))) return {0.0, 0.0, 0.0, {0.0}};
  const ContactSurface& surface = tissue.contact_surface();
  const double force = tool.force.norm(), scale = scale_of_force(t, force);
  if (!(force > 0.0)) return error_without_force(tissue, tool);
  ForceError error{0.0, 0.0, force, {0.0}}, own;
  const ForceAccuracy* const accuracy = accuracy_of(tissue);
  const double depth = indentation(t, tool);
  if (accuracy != nullptr) {
    ContactTool pressing = tool;
    if (scale > force) pressing.force = scale / force * tool.force;
    own = accuracy->error(pressing, static_cast<int>(t), rows_.contacts(), depth);
  }
  error.expected = own.expected * tool.force.squaredNorm() / (scale * force);
  error.parts.mesh = presses_beside_pad(t) ? infinity : own.bound;
  if (tissue.has_contact_materials() && is_as_measured(surface))
    add_model_errors(surface, t, {scale - own.expected, depth, tool.radius}, scale, error.parts);
  bool measured = error.parts.mesh < infinity;
  if (tool.half_length > 0.0) {
    const double coarse = accuracy != nullptr ? error_of_sphere(surface, *accuracy, t, tool) : infinity;
    measured = coarse < infinity;
    coarse_[t] = measured && coarse > flagged_error;
  }
  if (!surface.is_rigid())
    coarse_[t] = coarse_[t] || grasps_[t].is_coarse() || presses_coarse_facets(surface, t, tool, measured) ||
                 (!measured && bends_coarse_elements(surface, t, tool));
  error.parts.late = late_ ? infinity : 0.0;
  error.parts.merged = scale * (missing_depth() / (1.0 - missing_depth()) + error_of_points(t));
  error.bound = error.parts.sum();
  return error;
}

PALPATE_INLINE ContactSurface::Closest ContactProblem::closest(const TissueView& tissue, const Vector3& position,
                                                               double distance) noexcept {
  return detail::closest_deformed(tissue, displacement_, candidates_.subfacet(), position,
                                  distance + 2.0 * candidates_.reach(tissue, displacement_));
}

PALPATE_INLINE void ContactProblem::move_to(ContactProblem& fresh, const ContactSurface& surface) noexcept {
  displacement_.move_to(fresh.displacement_);
  start_.move_to(fresh.start_);
  candidates_.move_to(fresh.candidates_, surface);
  const auto renumber = [&](detail::PointLoad& load) {
    load.sample = candidates_.samples().nearest(surface, fresh.candidates_.samples()[load.sample], 0);
    if (load.sample < 0) return false;
    load.point = candidates_.half_space_point(load.sample);
    return load.point.is_known();
  };
  displacement_.renumber_loads(candidates_.samples(), renumber);
  start_.renumber_loads(candidates_.samples(), renumber);
  for (Grasp& g : grasps_) g.move_to(candidates_, fresh.candidates_.samples(), surface);
  rows_.move_to(fresh.rows_);
  levels_.change_points();
  pressing_count_ = violated_count_ = 0;
  feedback_ = 0.0;
  has_new_surface_ = true;
}

PALPATE_INLINE void ContactProblem::reset() noexcept {
  displacement_.reset();
  start_.reset();
  candidates_.reset();
  rows_.reset();
  levels_.reset();
  proxies_ = {};
  coarse_.fill(false);
  for (Grasp& g : grasps_) g.release();
  pressing_count_ = violated_count_ = 0;
  arrived_ = true;
  has_new_surface_ = false;
  feedback_ = of_lifted_ = most_of_lifted_ = 0.0;
  most_feedback_ = largest_feedback;
}

/// The middle of the points that a tool pressed in the last solution, weighted by their forces; zero without force [m].
inline Vector3 ContactProblem::middle_of_print(std::size_t t) const noexcept {
  Vector3 sum = Vector3::Zero();
  double all = 0.0;
  for (const Contact& c : rows_.contacts())
    if (c.tool == static_cast<int>(t) && !c.grasped && c.force > 0.0) sum += c.force * c.point, all += c.force;
  return all > 0.0 ? Vector3(sum / all) : sum;
}

/// The point that a tool grasps: of those that it presses the one nearest to their middle, since the gaps of all of
/// them are zero but for rounding; else the nearest one within its reach, or null.
PALPATE_INLINE detail::Candidate* ContactProblem::point_to_grasp(const TissueView& tissue, const ContactTool& tool,
                                                                 std::size_t t) noexcept {
  const Vector3 middle = middle_of_print(t);
  detail::Candidate *pressed = nullptr, *nearest = nullptr;
  for (detail::Candidate& c : candidates_.items()) {
    if (c.tool != static_cast<int>(t)) continue;
    if (candidates_.is_stale(c)) candidates_.evaluate(tissue, tool, displacement_, c);
    if (!c.facing || !(c.gap <= Grasp::reach * tool.radius)) continue;
    if (nearest == nullptr || c.gap < nearest->gap) nearest = &c;
    if (!(c.force > 0.0)) continue;
    if (pressed == nullptr || (c.point - middle).squaredNorm() < (pressed->point - middle).squaredNorm()) pressed = &c;
  }
  return pressed != nullptr ? pressed : nearest;
}

/// Grasps a point, or the pad around it, for every tool that has just begun to grasp, and releases others. Pads leave
/// half of the rows to points that press. Where other vertices are pinned than before, points have moved.
PALPATE_INLINE Status ContactProblem::grasp(const TissueView& tissue, Tools tools) noexcept {
  std::array<bool, maximum_tools> takes_pad{};
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const ContactTool& tool = tools[t];
    Grasp& g = grasps_[t];
    if (!tool.active || !tool.grasping) g.release();
    if (!tool.active || !tool.grasping || g.requested) continue;
    g.requested = true;
    constexpr double grasped_spacing = 0.25;  // radii; a single point holds at least so much of the surface
    detail::Candidate* const point = point_to_grasp(tissue, tool, t);
    if (point == nullptr) continue;
    point->area = std::max({point->area, candidates_.samples().area(point->sample, levels_.level(point->tool)),
                            std::pow(grasped_spacing * tool.radius, 2)});
    const int most = rows_.capacity() / (6 * static_cast<int>(tools.size()));
    takes_pad[t] = parameters_.grasp_radius > 0.0 && most > 2;
    if (takes_pad[t])
      g.grasp_pad(tissue.contact_surface(), candidates_, *point, tool, parameters_.grasp_radius, most);
    else
      g.grasp_point(*point, tool);
  }
  if (!pin_pads()) return {};
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (takes_pad[t]) grasps_[t].place_pad(tissue, candidates_, displacement_, tools[t]);
  rows_.forget_compliance();
  return candidates_.update_again(tissue, tools, displacement_);
}

/// Whether the vertices of all pads are others than before.
PALPATE_INLINE bool ContactProblem::pin_pads() noexcept {
  std::array<int, detail::Candidates::most_pinned> vertices;
  std::size_t count = 0;
  for (const Grasp& g : grasps_)
    for (const int v : g.pad()) vertices[count++] = v;
  if (!candidates_.pin({vertices.data(), count})) return false;
  displacement_.forget();
  start_.forget();
  return true;
}

/// Passes the vertices near the spheres to a tissue that prefetches.
PALPATE_INLINE void ContactProblem::prefetch(const TissueView& tissue) noexcept {
  if (!tissue.prefetches()) return;
  for (const detail::Candidate& c : candidates_.items()) {
    const detail::ContactSample& sample = candidates_.sample_of(c);
    for (std::size_t a = 0; a < 3; ++a)
      if (sample.weights[a] > 0.0) tissue.prefetch({&sample.vertices[a], 1});
  }
}

/// After a cut: the forces with which the points that pressed stay where they are. The forces before it could move a
/// part that hangs on less of the tissue so far away that the tools would lose it.
PALPATE_INLINE Status ContactProblem::balance(const TissueView& tissue, Tools tools) noexcept {
  pressing_count_ = 0;
  pressing_of_.fill(0);
  for (detail::Candidate& c : candidates_.items()) note_pressing(c);
  for (int i = 0; i < pressing_count_; ++i) {
    detail::Candidate& c = *pressing_[at(i)];
    set_area(c);
    candidates_.place(c, c.point, tools[at(c.tool)]);
  }
  add_rows(tissue);
  if (rows_.count() == 0) return {};
  const Status status = rows_.require_columns(tissue);
  rows_.build(tissue, candidates_, tools, floor_, 0);
  rows_.solve(0);
  if (rows_.has_friction()) rows_.slide();
  rows_.apply(tissue, candidates_, tools, displacement_);
  rows_.place_points();
  return status;
}

/// The rows of what is grasped, and of the points that press.
PALPATE_INLINE void ContactProblem::add_rows(const TissueView& tissue) noexcept {
  rows_.clear();
  for (Grasp& g : grasps_)
    for (detail::Candidate& c : g.rows())
      if (rows_.count() < rows_.capacity()) rows_.add(tissue, candidates_, c);
  for (int i = 0; i < pressing_count_; ++i) {
    detail::Candidate& c = *pressing_[at(i)];
    if (rows_.count() < rows_.capacity() && !is_grasped(tissue.contact_surface(), c))
      rows_.add(tissue, candidates_, c);
    else
      c.lift();  // only rows carry forces
  }
}

/// One Signorini problem, linearised where proxies and surface are (`start_`): distances and normals of all points stay
/// as they are there while rows are added until no point penetrates. The distance to a point is a convex function, so a
/// step of any length to the solution keeps all points out of the sphere. Updates the forces of points, vertices and
/// tools. The caller guarantees that rounds are left: the rows are those of the forces.
PALPATE_INLINE void ContactProblem::solve_linearised(const TissueView& tissue, Tools tools, int iteration,
                                                     Status& status) noexcept {
  gather_pressing(tissue, tools);
  predict_normals(iteration);
  add_rows(tissue);
  if (rows_.count() == 0) rows_.apply(tissue, candidates_, tools, displacement_);
  int built = 0;
  for (;; built = rows_.count()) {
    if (built > 0 || rows_.count() == 0) add_violated(tissue, tools, built);
    if (rows_.count() == built) break;
    if (rounds_left_-- <= 0) {
      status.set(StatusFlag::solver_not_converged);
      break;
    }
    const Status columns = rows_.require_columns(tissue);
    status |= columns;
    late_ = late_ || columns.has(StatusFlag::degraded_model);
    rows_.build(tissue, candidates_, tools, floor_, built);
    if (!rows_.solve(built)) status.set(StatusFlag::solver_not_converged);
    rows_.apply(tissue, candidates_, tools, displacement_);
    if (iteration == 0 && built == 0) correct_normals(tissue, tools, status);
  }
  if (rows_.has_friction() && built > 0 && built == rows_.count()) {
    if (!rows_.slide()) status.set(StatusFlag::solver_not_converged);
    rows_.apply(tissue, candidates_, tools, displacement_);
  }
}

/// Where normals at the solution differ so much from those of the linearisation that another one would follow: they are
/// corrected at a fraction of its cost.
PALPATE_INLINE void ContactProblem::correct_normals(const TissueView& tissue, Tools tools, Status& status) noexcept {
  const double change = proxies_.relative_change(tools, rows_.largest_force_scale(tools));
  if (first_change_safety * change <= parameters_.force_tolerance) return;
  for (int k = 0; k < most_corrections; ++k) {
    const double estimate = estimate_safety * rows_.remaining_change(tools);
    if (estimate <= parameters_.force_tolerance || !(estimate <= largest_correction)) return;
    if (!rows_.correct_normals(tools)) status.set(StatusFlag::solver_not_converged);
    rows_.apply(tissue, candidates_, tools, displacement_);
  }
}

/// Lists the candidates that press and updates their geometry for the present positions of sphere and surface.
PALPATE_INLINE void ContactProblem::gather_pressing(const TissueView& tissue, Tools tools) noexcept {
  pressing_count_ = 0;
  pressing_of_.fill(0);
  if (candidates_.is_new()) {
    for (detail::Candidate& c : candidates_.items()) note_pressing(c);
  } else {
    for (int i = 0; i < rows_.count(); ++i) note_pressing(rows_.candidate(i));
  }
  for (int i = 0; i < pressing_count_; ++i) {
    detail::Candidate& c = *pressing_[at(i)];
    const ContactTool& tool = tools[at(c.tool)];
    set_area(c);
    if (arrived_) {
      candidates_.place(c, c.point, tool);
    } else {
      c.history.known = 0;
      if (candidates_.is_stale(c)) candidates_.evaluate(tissue, tool, start_, c);
    }
  }
}

/// The normals of a linearisation depend on the forces of the one before, which depend on its normals. `feedback_` is
/// the ratio of successive changes of the normals; a Newton step on that scalar extrapolates to the fixed point. Parts
/// of the normals that do not feed back swing with a large ratio: that of the last tick counts less, and
/// `most_feedback_` is a limit.
PALPATE_INLINE void ContactProblem::predict_normals(int iteration) noexcept {
  constexpr double most_before = 0.4;
  double back = 0.0, changed = 0.0;
  for (int i = 0; i < pressing_count_ && iteration >= 2; ++i) {
    const detail::Candidate& c = *pressing_[at(i)];
    if (c.history.known < 2) continue;
    const Vector3 before = c.history.used - c.history.used_before;
    back += c.force * before.dot(c.normal - c.history.made_before);
    changed += c.force * before.squaredNorm();
  }
  if (changed > 1e-16) feedback_ = std::clamp(back / changed, 0.0, largest_feedback);
  const double ratio = std::min(std::min(feedback_, most_feedback_), iteration < 2 ? most_before : largest_feedback);
  for (int i = 0; i < pressing_count_; ++i) {
    detail::Candidate& c = *pressing_[at(i)];
    const Vector3 made = c.normal;
    if (c.history.known > 0) c.normal = (made + ratio / (1.0 - ratio) * (made - c.history.used)).normalized();
    c.history = {c.normal, c.history.used, made, std::min(c.history.known + 1, 2)};
  }
}

/// Where several tools press, perhaps against each other: the limit is halved after a linearisation in which the force
/// changed by more than in the one before, a tenth more after each tick that has converged. The normals of a single
/// tool change together, so that their ratio can be trusted.
PALPATE_INLINE void ContactProblem::limit_feedback(bool converged, bool grows) noexcept {
  constexpr double smaller = 0.5, larger = 1.1, least_step = 0.01;
  int pressing = 0;
  for (const int points : pressing_of_) pressing += points > 0;
  if (pressing < 2)
    most_feedback_ = largest_feedback;
  else if (converged)
    most_feedback_ = std::min(largest_feedback, larger * most_feedback_ + least_step);
  else if (grows)
    most_feedback_ *= smaller;
}

/// Adds rows for the points that would penetrate deepest with the present forces. Where there is no room because all
/// rows press, those that pressed first keep theirs. `built` is zero when idle rows were dropped.
PALPATE_INLINE void ContactProblem::add_violated(const TissueView& tissue, Tools tools, int& built) noexcept {
  violated_count_ = 0;
  levels_.begin_round();
  proxies_.look_ahead(tools, floor_);
  const double unnoticed = violation * rows_.deepest_push();  // by the force
  std::array<double, maximum_tools> reaches{};
  for (std::size_t t = 0; t < tools.size(); ++t) reaches[t] = proxies_.ahead(t).farthest + 2.0 * rows_.longest_path();
  for (detail::Candidates::Near& item : candidates_.within(reaches, tools)) {
    const double reach = reaches[at(item.tool)];
    if (candidates_.least_gap(item) > reach) continue;
    detail::Candidate& c = candidates_.items()[at(item.number)];
    candidates_.note_gap(item);
    if (c.row >= 0 || candidates_.least_gap(c) > reach) continue;
    const bool is_finer = !may_have_row(c);
    if ((is_finer && levels_.has_areas()) || is_grasped(tissue.contact_surface(), c)) continue;
    const ContactTool& tool = tools[at(c.tool)];
    const detail::ProxyMotion::Ahead& ahead = proxies_.ahead(at(c.tool));
    if (candidates_.is_stale(c)) {
      const bool is_far = candidates_.raise_least_gap(tissue, tool, start_, c) > reach;
      if (!is_far) candidates_.evaluate(tissue, tool, start_, c);
      candidates_.note_gap(item);
      if (is_far) continue;
    }
    double gap = c.gap + c.normal.dot(ahead.path);
    if (tool.half_length > 0.0) gap += c.normal.dot(ahead.turn * c.core);
    if (!c.facing || gap > 2.0 * rows_.longest_path()) continue;
    if (gap > candidates_.longest_move(tissue, displacement_, c)) continue;
    const Vector3& point = candidates_.position(tissue, displacement_, c);
    gap -= c.normal.dot(point - c.point);
    // Of the dent there, not of the push: a support does not yield, and rounding would choose which of its points
    // press.
    const double dent = c.normal.dot(candidates_.rest(tissue.contact_surface(), candidates_.sample_of(c)) - point);
    const double allowed = built > 0 ? violation * std::abs(dent) : 0.0;
    if (!(gap < -std::max(allowed, rounding * tool.radius))) continue;
    if (is_finer)
      levels_.note_skipped(c.tool, gap < -unnoticed ? -gap : 0.0);
    else
      violated_[at(violated_count_++)] = {gap, &c};
  }
  std::array<int, maximum_tools> own = rows_.count_by_tool();
  std::array<int, maximum_tools> wanted = own;
  bool crowded = rows_.count() + std::min(violated_count_, added_per_round) > rows_.capacity();
  for (int i = 0; i < violated_count_; ++i)
    crowded =
        ++wanted[at(violated_[at(i)].candidate->tool)] > levels_.share(violated_[at(i)].candidate->tool) || crowded;
  if (crowded && violated_count_ > 0 && rows_.drop_idle(tissue, candidates_)) {
    built = 0;
    own = rows_.count_by_tool();
  }
  const auto end = std::partition(violated_.begin(), violated_.begin() + violated_count_, [&](const Violated& v) {
    return own[at(v.candidate->tool)] < levels_.share(v.candidate->tool);
  });
  const auto fitting = static_cast<int>(end - violated_.begin());
  const int adding = std::min({fitting, added_per_round, rows_.capacity() - rows_.count()});
  std::partial_sort(violated_.begin(), violated_.begin() + adding, end,
                    [](const Violated& a, const Violated& b) { return a.gap < b.gap; });
  for (int i = 0; i < adding; ++i) {
    detail::Candidate& c = *violated_[at(i)].candidate;
    if (own[at(c.tool)] >= levels_.share(c.tool)) continue;
    ++own[at(c.tool)];
    set_area(c);
    rows_.inherit_friction(tools[at(c.tool)], c);
    rows_.add(tissue, candidates_, c);
  }
  const bool full = rows_.count() == rows_.capacity();
  for (int i = 0; i < violated_count_; ++i) {
    const auto& [gap, c] = violated_[at(i)];
    if (c->row < 0 && (full || own[at(c->tool)] >= levels_.share(c->tool))) levels_.note_left_out(c->tool, -gap);
  }
}

/// Takes the step to the solution, or the part of it within which the list of candidates is complete.
PALPATE_INLINE void ContactProblem::follow(const TissueView& tissue, Tools tools) noexcept {
  const double part = proxies_.follow(tools, floor_, rows_.longest_path());
  arrived_ = proxies_.arrived();
  of_lifted_ = part < 1.0 ? (1.0 - part) * of_lifted_ : 0.0;
  if (part == 1.0)
    rows_.place_points();
  else
    displacement_.blend(tissue, start_, part, candidates_.subfacet(), candidates_.samples());
  candidates_.move_surface(2.0 * part * rows_.longest_path());
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active) candidates_.move_sphere(t, tools[t]);
}

}}  // namespace palpate
