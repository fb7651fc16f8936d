// Rigid balls against a deformable surface, solved exactly in every tick.
#pragma once

#include <palpate/contact/candidates.hpp>
#include <palpate/contact/complementarity.hpp>
#include <palpate/contact/point_compliance.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate::inline PALPATE_ABI {

/// All contacts of all tools with one tissue. The surface is held off the ball at material points: vertices, and a
/// lattice on edges longer than `sample_spacing` radii. Points fixed in the material meet a sliding ball one after the
/// other, each with zero force at first, so the force has no jump at edges. Each tick linearises the distance between
/// ball and deformed surface at the last proxy position (Ruspini's proxy on a deforming surface), solves the Signorini
/// problem on the contact compliance J C J^T exactly, and repeats while the force still changes. Rows of that problem
/// are the points that pressed last and those the answer would let sink in, added until there are none. The coupling
/// between proxy and device enters as n_i . n_j / k between contacts of one tool: the device never feels more than k,
/// however many contacts there are, and the proxy never sinks in. docs/contact.md has the law, its limits and figures.
/// Work is bounded by `Capacity`, iterations, rounds and candidates.
template <int Capacity = 64>
class ContactProblem {
 public:
  /// Places the contact points for balls of at least `smallest_radius` [m]. Allocates workspaces; for set-up.
  /// Throws bad_argument unless 0.4 <= sample_spacing <= 1 and there is at least one iteration.
  ContactProblem(const ContactSurface& surface, double smallest_radius, ContactParameters parameters = {})
      : parameters_(checked(parameters)),
        displacement_(surface.vertex_count()),
        candidates_(surface, parameters.sample_spacing * smallest_radius),
        slot_(static_cast<std::size_t>(surface.vertex_count()), -1) {}

  /// Finds the forces for the tools' new targets; updates proxy and force of every active tool. At most
  /// `maximum_tools` tools. Never allocates.
  template <TissueModel Tissue>
  Status solve(Tissue& tissue, std::span<ContactTool> tools) noexcept {
    Status status;
    floor_ = tissue.compliance_floor();
    rounds_left_ = maximum_rounds;
    compliance_.begin_tick(tissue.compliance_revision());
    slide(tools);
    candidates_.begin_tick(tissue.contact_surface(), tools);
    candidates_.look_round(tissue, tools, displacement_);
    double change = 0.0, before = 0.0;
    for (int iteration = 0; iteration < parameters_.maximum_iterations; ++iteration) {
      for (std::size_t t = 0; t < tools.size(); ++t) start_force_[t] = tools[t].force;
      status |= candidates_.update(tissue, tools, displacement_);
      if (candidates_.is_new()) foresee(tissue);
      status |= solve_linearised(tissue, tools, iteration);
      follow(tools);
      change = relative_change(tools);
      // Each step is smaller than the last by about the same ratio (the curvature of the ball is left out of the
      // linearisation), so that the steps still to come sum to this. The first step is the hand's, so that the second
      // says nothing about the ratio yet.
      const double expected = iteration == 0                   ? 10.0 * change
                              : iteration > 1 && change < before ? change * change / (before - change)
                                                                 : change;
      if (arrived_ && !candidates_.has_lost_forces() && expected <= parameters_.force_tolerance) return status;
      before = change;
    }
    if (change > unsettled) status.set(StatusFlag::solver_not_converged);
    return status;
  }

  /// Forgets all contact forces, as when every tool was lifted.
  void clear() noexcept {
    displacement_.clear();
    for (Candidate& c : candidates_.items()) c.force = 0.0;
    candidates_.forget();
    row_count_ = 0;
  }

  /// Rows of the last linearisation: what presses, and what would have sunk in without; some without force.
  std::span<const Contact> contacts() const noexcept { return {rows_.data(), static_cast<std::size_t>(row_count_)}; }
  /// The forces of the last tick on the vertices.
  std::span<const VertexForce> vertex_forces() const noexcept { return displacement_.forces(); }
  /// Whether a contact point is near a tool's ball.
  bool is_near(int tool) const noexcept { return candidates_.has_any(tool); }

 private:
  using Tools = std::span<ContactTool>;

  /// Takes the proxies along with their devices, across the contact force: from there the first linearisation is nearly
  /// right for a ball that slides.
  static void slide(Tools tools) noexcept {
    for (ContactTool& tool : tools) {
      const double force = tool.force.squaredNorm();
      if (!tool.active || force == 0.0 || tool.motion.norm() > 0.1 * tool.radius) continue;
      tool.proxy += tool.motion - (tool.force.dot(tool.motion) / force) * tool.force;
    }
  }

  /// Tells a tissue that wants to know which vertices lie near the balls.
  template <TissueModel Tissue>
  void foresee(Tissue& tissue) noexcept {
    if constexpr (requires(std::span<const int> vertices) { tissue.foresee(vertices); })
      for (const Candidate& c : candidates_.items()) {
        const ContactSample& sample = candidates_.samples()[c.sample];
        for (std::size_t a = 0; a < 3; ++a)
          if (sample.weights[a] > 0.0) tissue.foresee({&sample.vertices[a], 1});
      }
  }

  /// One Signorini problem at the present proxies; updates the forces of points, vertices and tools. Rows are added
  /// until no point sinks in.
  template <TissueModel Tissue>
  Status solve_linearised(Tissue& tissue, Tools tools, int iteration) noexcept {
    Status status;
    gather_pressing(tools);
    predict_normals(iteration);
    row_count_ = 0;
    compliance_.begin_rows();
    for (int i = 0; i < pressing_count_; ++i) add_row(tissue.contact_surface(), *pressing_[at(i)]);
    for (int built = 0;; built = row_count_) {
      if (built > 0 || row_count_ == 0)
        if (!add_violated(tissue, tools, built)) status.set(StatusFlag::degraded_model);
      if (row_count_ == built) {
        if (built == 0) apply(tools);
        break;
      }
      if (rounds_left_-- <= 0) {
        status.set(StatusFlag::solver_not_converged);
        break;
      }
      status |= require_columns(tissue);
      build(tissue, tools, built);
      if (!problem_.solve()) status.set(StatusFlag::solver_not_converged);
      apply(tools);
    }
    return status;
  }

  /// Lists the candidates that press and puts them where ball and surface are now.
  void gather_pressing(Tools tools) noexcept {
    pressing_count_ = 0;
    if (candidates_.is_new()) {
      for (Candidate& c : candidates_.items())
        if (c.force > 0.0) pressing_[at(pressing_count_++)] = &c;
    } else {
      for (int i = 0; i < row_count_; ++i) {
        candidate_[at(i)]->row = -1;
        if (candidate_[at(i)]->force > 0.0) pressing_[at(pressing_count_++)] = candidate_[at(i)];
      }
    }
    for (int i = 0; i < pressing_count_; ++i) {
      Candidate& c = *pressing_[at(i)];
      if (!arrived_) c.history.known = 0;
      candidates_.place(c, c.point, tools[at(c.tool)]);
    }
  }

  /// The normals of a linearisation come of the forces of the one before, which come of its normals. `feedback_` is how
  /// much of a change of normals comes back; a step of Newton's method on that scalar leads on to where they settle.
  void predict_normals(int iteration) noexcept {
    double back = 0.0, changed = 0.0;
    for (int i = 0; i < pressing_count_ && iteration >= 2; ++i) {
      const Candidate& c = *pressing_[at(i)];
      if (c.history.known < 2) continue;
      const Vector3 before = c.history.used - c.history.used_before;
      back += c.force * before.dot(c.normal - c.history.made_before);
      changed += c.force * before.squaredNorm();
    }
    if (changed > 1e-16) feedback_ = std::clamp(back / changed, 0.0, 0.75);
    for (int i = 0; i < pressing_count_; ++i) {
      Candidate& c = *pressing_[at(i)];
      const Vector3 made = c.normal;
      if (c.history.known > 0)
        c.normal = (made + feedback_ / (1.0 - feedback_) * (made - c.history.used)).normalized();
      c.history = {c.normal, c.history.used, made, std::min(c.history.known + 1, 2)};
    }
  }

  /// Makes rows of the points that would sink in deepest with the present forces; false when there is no room.
  template <TissueModel Tissue>
  bool add_violated(const Tissue& tissue, Tools tools, int& built) noexcept {
    violated_count_ = 0;
    const double allowed = built > 0 ? violation * std::max(0.0, -problem_.b.minCoeff()) : 0.0;
    for (Candidate& c : candidates_.items()) {
      if (c.row >= 0) continue;
      const ContactTool& tool = tools[at(c.tool)];
      const Vector3 ahead = tool.goal(floor_) - tool.proxy;
      if (candidates_.least_gap(c) > ahead.norm()) continue;
      if (candidates_.is_stale(c)) candidates_.evaluate(tissue, tool, displacement_, c);
      const double gap = c.gap + c.normal.dot(ahead);
      if (c.facing && gap < -allowed) violated_[at(violated_count_++)] = {gap, &c};
    }
    const auto wanted = std::min(violated_count_, added_per_round);
    std::partial_sort(violated_.begin(), violated_.begin() + wanted, violated_.begin() + violated_count_,
                      [](const Violated& a, const Violated& b) { return a.gap < b.gap; });
    if (row_count_ + wanted > Capacity) built = drop_idle_rows();
    const int room = std::min(wanted, Capacity - row_count_);
    for (int i = 0; i < room; ++i) add_row(tissue.contact_surface(), *violated_[at(i)].candidate);
    return room > 0 || wanted == 0;
  }

  /// There is always room: the caller has seen to it.
  void add_row(const ContactSurface& surface, Candidate& c) noexcept {
    c.row = row_count_;
    c.slot = compliance_.slot_of(c.sample, c.slot);
    const ContactSample& sample = candidates_.samples()[c.sample];
    candidate_[at(row_count_)] = &c;
    Contact& row = rows_[at(row_count_++)];
    row.tool = c.tool;
    row.vertices = sample.vertices;
    row.weights = sample.weights;
    row.normal = c.normal;
    row.rest = candidates_.rest(surface, c.sample);
    row.point = c.point;
    row.gap = c.gap;
    row.force = c.force;
  }

  /// Rows without force make room; the number of rows whose compliance is built is then none.
  int drop_idle_rows() noexcept {
    int kept = 0;
    compliance_.begin_rows();
    for (int i = 0; i < row_count_; ++i) {
      Candidate& c = *candidate_[at(i)];
      c.row = rows_[at(i)].force > 0.0 ? kept : -1;
      if (c.row < 0) continue;
      c.slot = compliance_.slot_of(c.sample, c.slot);
      candidate_[at(kept)] = &c;
      rows_[at(kept++)] = rows_[at(i)];
    }
    row_count_ = kept;
    return 0;
  }

  /// Asks for the compliance columns of all vertices that carry rows.
  template <TissueModel Tissue>
  Status require_columns(Tissue& tissue) noexcept {
    int count = 0;
    for (const Contact& row : contacts())
      for (std::size_t a = 0; a < 3; ++a) {
        int& slot = slot_[at(row.vertices[a])];
        if (row.weights[a] == 0.0 || slot >= 0) continue;
        slot = count;
        vertices_[at(count++)] = row.vertices[a];
      }
    for (int i = 0; i < count; ++i) slot_[at(vertices_[at(i)])] = -1;
    return tissue.require_columns({vertices_.data(), at(count)});
  }

  /// Rows `first` and later of W = J C J^T plus the coupling, and of b = gap at the target without contact force.
  template <TissueModel Tissue>
  void build(const Tissue& tissue, Tools tools, int first) noexcept {
    problem_.resize(row_count_);
    for (int i = first; i < row_count_; ++i) {
      problem_.lambda[i] = 1.0;  // it presses, or would sink in
      const Contact& ci = rows_[at(i)];
      const ContactTool& tool = tools[at(ci.tool)];
      problem_.b[i] = ci.normal.dot(tool.target - ci.rest) - tool.radius;
      for (int j = 0; j <= i; ++j) {
        const Contact& cj = rows_[at(j)];
        double w = set_responses(tissue, i, j);
        if (ci.tool == cj.tool) w += (tool.compliance + floor_) * ci.normal.dot(cj.normal);
        problem_.w(i, j) = problem_.w(j, i) = w;
      }
    }
  }

  /// Displacement of two rows' points per force on the other. Returns the part of it along the own normal. Written out
  /// so that it stays in registers: half of the work of a tick with many contacts is here.
  template <TissueModel Tissue>
  double set_responses(const Tissue& tissue, int i, int j) noexcept {
    const int p = candidate_[at(i)]->slot, q = candidate_[at(j)]->slot;
    if (p < q) return set_responses(tissue, j, i);
    const Matrix3& c = compliance_(tissue, candidates_.samples(), p, q);
    const double *m = rows_[at(i)].normal.data(), *n = rows_[at(j)].normal.data();
    const double x = c(0, 0) * n[0] + c(0, 1) * n[1] + c(0, 2) * n[2];
    const double y = c(1, 0) * n[0] + c(1, 1) * n[1] + c(1, 2) * n[2];
    const double z = c(2, 0) * n[0] + c(2, 1) * n[1] + c(2, 2) * n[2];
    response_[at(i)][at(j)] = {x, y, z};
    response_[at(j)][at(i)] = {c(0, 0) * m[0] + c(1, 0) * m[1] + c(2, 0) * m[2],
                               c(0, 1) * m[0] + c(1, 1) * m[1] + c(2, 1) * m[2],
                               c(0, 2) * m[0] + c(1, 2) * m[1] + c(2, 2) * m[2]};
    return m[0] * x + m[1] * y + m[2] * z;
  }

  /// Hands the answer to points, vertices and tools.
  void apply(Tools tools) noexcept {
    displacement_.clear();
    for (ContactTool& tool : tools) tool.force.setZero();
    double largest = 0.0;
    for (int i = 0; i < row_count_; ++i) {
      Contact& row = rows_[at(i)];
      row.force = problem_.lambda[i];
      Vector3 point = row.rest;
      for (int j = 0; j < row_count_; ++j)
        if (problem_.lambda[j] > 0.0) point.noalias() -= problem_.lambda[j] * response_[at(i)][at(j)];
      largest = std::max(largest, (point - row.point).squaredNorm());
      row.point = point;
      if (row.force == 0.0) continue;
      tools[at(row.tool)].force += row.force * row.normal;
      for (std::size_t a = 0; a < 3; ++a)
        if (row.weights[a] > 0.0)
          displacement_.add(row.vertices[a], -(row.force * row.weights[a]) * row.normal, slot_[at(row.vertices[a])]);
    }
    for (const VertexForce& f : displacement_.forces()) slot_[at(f.vertex)] = -1;
    candidates_.move_surface(2.0 * std::sqrt(largest));
    for (int i = 0; i < row_count_; ++i) {
      Candidate& c = *candidate_[at(i)];
      candidates_.place(c, rows_[at(i)].point, tools[at(c.tool)]);
      c.force = rows_[at(i)].force;
      if (c.force == 0.0) c.history.known = 0;
      rows_[at(i)].gap = c.gap;
    }
  }

  /// Moves the proxies to where the answer has them, as far as one linearisation may go.
  void follow(Tools tools) noexcept {
    arrived_ = true;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      ContactTool& tool = tools[t];
      if (!tool.active) continue;
      const Vector3 step = tool.goal(floor_) - tool.proxy;
      const double length = step.norm(), longest = tool.longest_step();
      tool.proxy += length <= longest ? step : Vector3((longest / length) * step);
      arrived_ = arrived_ && length <= longest;
      candidates_.move_ball(t, tool.proxy);
    }
  }

  /// Of the tools' forces in this linearisation.
  double relative_change(Tools tools) const noexcept {
    double change = 0.0, scale = 0.0;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      change = std::max(change, (tools[t].force - start_force_[t]).norm());
      scale = std::max(scale, tools[t].force.norm());
    }
    return change > 0.0 ? change / scale : 0.0;
  }

  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  static ContactParameters checked(const ContactParameters& p) {
    if (!(p.sample_spacing >= 0.4 && p.sample_spacing <= 1.0))
      raise(SetupErrorKind::bad_argument, "the sample spacing is " + number(p.sample_spacing) + " radii",
            "Below 0.4 there is no room for all points under a ball, above 1 the ball falls between them");
    if (p.maximum_iterations < 1) raise(SetupErrorKind::bad_argument, "a tick needs at least one linearisation");
    return p;
  }

  static constexpr auto capacity = static_cast<std::size_t>(Capacity);
  static constexpr int maximum_rounds = 12;   // solutions of the contact problem per tick
  static constexpr int added_per_round = 16;  // rows, the deepest ones
  static constexpr double unsettled = 0.05;   // relative change of force in the last linearisation that is flagged
  static constexpr double violation = 1e-5;   // how far a point may sink in, of the deepest push
  struct Violated {
    double gap;
    Candidate* candidate;
  };

  ContactParameters parameters_;
  SurfaceDisplacement<3 * Capacity> displacement_;
  Candidates<Capacity> candidates_;
  ComplementarityProblem<Capacity> problem_;
  PointCompliance<Capacity> compliance_;
  std::array<Contact, capacity> rows_{};
  std::array<Candidate*, capacity> candidate_{}, pressing_{};  // of the rows; of the last linearisation
  std::array<std::array<Vector3, capacity>, capacity> response_{};  // of a row's point to unit force on another
  std::array<int, 3 * capacity> vertices_{};
  std::vector<int> slot_;  // scratch per vertex: -1 between calls
  std::array<Violated, static_cast<std::size_t>(Candidates<Capacity>::maximum)> violated_{};
  std::array<Vector3, maximum_tools> start_force_{};
  int row_count_ = 0, pressing_count_ = 0, violated_count_ = 0, rounds_left_ = 0;
  bool arrived_ = true;  // at the answer of the last linearisation
  double feedback_ = 0.0;
  double floor_ = 0.0;
};

}  // namespace palpate::inline PALPATE_ABI
