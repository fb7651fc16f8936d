// Definitions of contact_rows.hpp.
#pragma once

#include <palpate/contact/detail/contact_kernels.hpp>
#include <palpate/contact/detail/contact_rows.hpp>
#include <palpate/contact/detail/contact_rows_directions.ipp>  // inline functions

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE ContactRows::ContactRows(int vertices, double friction, int capacity)
    : capacity_(capacity),
      problem_(capacity),
      friction_(friction, capacity),
      free_gap_(at(capacity)),
      pressed_(at(capacity)),
      compliance_(capacity),
      rows_(at(capacity)),
      candidate_(at(capacity)),
      stored_(capacity, contact_kernels()),
      forces_(capacity),
      moved_(capacity),
      in_axes_(friction > 0.0 ? 9 * stored_.stride() : 0),
      remaining_(at(capacity)),
      redirected_(at(capacity)),
      vertices_(3 * at(capacity)),
      slot_(at(vertices), -1) {}

/// Contact point on the tool for the point of a row.
inline void ContactRows::reach(const ContactTool& tool, const Candidate& c, Contact& row) noexcept {
  if (c.grasped) {
    row.arm = tool.rotation * c.anchor;
    row.offset = row.normal.dot(tool.target_rotation * c.anchor);
    return;
  }
  row.arm = -tool.radius * row.normal;
  row.offset = -tool.radius;
  if (tool.half_length == 0.0) {
    row.arm += c.core;  // beside its cap; across the normal
    return;
  }
  row.arm += tool.rotation * c.core;
  row.offset += row.normal.dot(tool.target_rotation * c.core);
}

/// Only of points at the same place: out of line, so that what is common is inlined.
PALPATE_INLINE const Matrix3& ContactRows::with_self_compliance(const TissueView& tissue, const Candidates& points,
                                                                int i, int j, const Matrix3& compliance,
                                                                Matrix3& workspace) noexcept {
  const Candidate &c = *candidate_[at(i)], &other = *candidate_[at(j)];
  if (!compliance_.have_same_place(points, c.slot, other.slot)) return compliance;
  const double area = i == j ? c.area : std::sqrt(c.area * other.area);
  workspace = half_space_self_compliance(compliance_.half_space_point(c.slot), area);
  if (tissue.has_half_space_map())
    workspace = (compliance_.map(c.slot) * workspace * compliance_.map(other.slot).transpose()).eval();
  const double own = workspace.trace();
  workspace += compliance;
  if (i == j) remaining_[at(i)] = workspace.trace() / own;
  return workspace;
}

/// Stores the blocks of row i, unless they are known from the last linearisation.
PALPATE_INLINE void ContactRows::store_compliance(const TissueView& tissue, const Candidates& points, int i) noexcept {
  const int p = candidate_[at(i)]->slot;
  const RowCompliance::Key key{compliance_.version(p), candidate_[at(i)]->area};
  if (stored_.knows(i, key)) return;
  remaining_[at(i)] = 1.0;
  stored_.begin_row(i, key);
  Matrix3 workspace;
  for (int j = 0; j <= i; ++j)
    if (p >= candidate_[at(j)]->slot)
      stored_.set(i, j, between(tissue, points, i, j, workspace));
    else
      stored_.set(i, j, between(tissue, points, j, i, workspace).transpose());
}

/// Row and column i of W, of rows up to i.
PALPATE_INLINE void ContactRows::build_row(const ContactTool& tool, int i) noexcept {
  double *const column = &problem_.w(0, i), *row = &problem_.w(i, 0);
  if (friction_.acts()) {
    stored_.in_axes(i, coupling_of(tool), in_axes_.data());
    friction_.set_row(i, in_axes_.data(), stored_.stride());
    for (int j = 0; j <= i; ++j) column[j] = in_axes_[8 * stored_.stride() + at(j)];
  } else {
    stored_.along_normals(i, coupling_of(tool), column);
  }
  for (int j = 0; j < i; ++j, row += problem_.stride()) *row = column[j];
}

PALPATE_INLINE void ContactRows::begin_tick(std::uint64_t compliance_revision) noexcept {
  compliance_.begin_tick(compliance_revision);
  ++tick_;
}

PALPATE_INLINE void ContactRows::clear() noexcept {
  count_ = 0;
  longest_path_ = alternation_change_ = 0.0;
  compliance_.begin_rows();
}

PALPATE_INLINE void ContactRows::reset() noexcept {
  clear();
  compliance_.reset();
  pressing_force_.fill(0.0);
  pressed_tick_.fill(0);
  tick_ = 0;
}

PALPATE_INLINE void ContactRows::move_to(ContactRows& fresh) noexcept {
  clear();
  compliance_.forget();
  slot_.swap(fresh.slot_);
}

PALPATE_INLINE void ContactRows::add(const TissueView& tissue, const Candidates& candidates, Candidate& c) noexcept {
  c.row = count_;
  c.slot = compliance_.slot_of(tissue, candidates, c.sample, c.slot);
  const ContactSample& sample = candidates.sample_of(c);
  candidate_[at(count_)] = &c;
  Contact& row = rows_[at(count_++)];
  row.tool = c.tool;
  row.vertices = sample.vertices;
  row.weights = sample.weights;
  row.normal = c.normal;
  row.rest = candidates.rest(tissue.contact_surface(), sample);
  row.point = c.point;
  row.force = c.force;
  row.friction = c.friction;
  row.grasped = c.grasped;
}

PALPATE_INLINE std::array<int, maximum_tools> ContactRows::count_by_tool() const noexcept {
  std::array<int, maximum_tools> counts{};
  for (const Contact& row : contacts()) ++counts[at(row.tool)];
  return counts;
}

PALPATE_INLINE std::array<int, maximum_tools> ContactRows::count_pressing() const noexcept {
  std::array<int, maximum_tools> counts{};
  for (const Contact& row : contacts()) counts[at(row.tool)] += row.force > 0.0 && !row.grasped;
  return counts;
}

PALPATE_INLINE std::array<double, maximum_tools> ContactRows::points_of_print() const noexcept {
  constexpr double of_hertz = 9.0 / 8.0, least_part = 0.5;
  std::array<double, maximum_tools> sums{}, squares{}, points{};
  std::array<Vector3, maximum_tools> resultants;
  resultants.fill(Vector3::Zero());
  for (const Contact& row : contacts()) {
    if (!(row.force > 0.0) || row.grasped) continue;
    sums[at(row.tool)] += row.force;
    squares[at(row.tool)] += row.force * row.force;
    resultants[at(row.tool)] += row.force * row.normal;
  }
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    if (!(squares[t] > 0.0)) continue;
    const double squared = sums[t] * sums[t], part = std::max(least_part, resultants[t].squaredNorm() / squared);
    points[t] = of_hertz * part * squared / squares[t];
  }
  return points;
}

PALPATE_INLINE bool ContactRows::drop_idle(const TissueView& tissue, const Candidates& candidates) noexcept {
  const auto works = [this](int i) { return rows_[at(i)].force > 0.0 || candidate_[at(i)]->grasped; };
  int kept = 0;
  while (kept < count_ && works(kept)) ++kept;
  if (kept == count_) return false;
  kept = 0;
  compliance_.begin_rows();
  for (int i = 0; i < count_; ++i) {
    Candidate& c = *candidate_[at(i)];
    c.row = works(i) ? kept : -1;
    if (c.row < 0) continue;
    c.slot = compliance_.slot_of(tissue, candidates, c.sample, c.slot);
    candidate_[at(kept)] = &c;
    rows_[at(kept++)] = rows_[at(i)];
  }
  count_ = kept;
  return true;
}

PALPATE_INLINE Status ContactRows::require_columns(const TissueView& tissue) noexcept {
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

PALPATE_INLINE void ContactRows::build(const TissueView& tissue, const Candidates& points,
                                       std::span<const ContactTool> tools, double floor, int first) noexcept {
  floor_ = floor;
  has_copies_ = points.subfacet() != nullptr && points.subfacet()->has_copies();
  problem_.resize(count_);
  for (int i = first; i < count_; ++i) {
    problem_.lambda[at(i)] = 1.0;  // it presses, or would penetrate
    Contact& ci = rows_[at(i)];
    const ContactTool& tool = tools[at(ci.tool)];
    problem_.bilateral[at(i)] = ci.grasped;
    reach(tool, *candidate_[at(i)], ci);
    problem_.b[at(i)] = free_gap_[at(i)] = ci.normal.dot(tool.target - ci.rest) + ci.offset;
    store_compliance(tissue, points, i);
    stored_.set_tool(i, ci.tool, ci.arm);
    stored_.set_axis(i, RowCompliance::normal, ci.normal);
    if (friction_.acts()) set_friction(tool, i);
  }
  // After all axes: reading them at once right after they were written one by one is slow.
  for (int i = first; i < count_; ++i) build_row(tools[at(rows_[at(i)].tool)], i);
  if (!friction_.acts()) return;
  for (int i = 0; i < count_; ++i) pressed_[at(i)] = candidate_[at(i)]->force;
  friction_.begin(count_, pressed_.data());
}

PALPATE_INLINE bool ContactRows::solve(int first) noexcept {
  if (friction_.acts()) update_gaps();
  const bool solved = first > 0 ? problem_.solve_added(first) : problem_.solve();
  if (friction_.acts()) friction_.press(problem_.lambda.data());
  return solved;
}

PALPATE_INLINE double ContactRows::push_work(int tool) const noexcept {
  double work = 0.0;
  for (int i = 0; i < count_; ++i)
    if (rows_[at(i)].tool == tool) work += push_work_of_row(i);
  return work;
}

PALPATE_INLINE double ContactRows::largest_force_scale(std::span<const ContactTool> tools) const noexcept {
  double largest = 0.0;
  for (std::size_t t = 0; t < tools.size(); ++t)
    largest = std::max(largest, force_scale(tools[t].force.norm(), pressing_force_[t]));
  return largest;
}

PALPATE_INLINE double ContactRows::deepest_push() const noexcept {
  double deepest = 0.0;
  for (int i = 0; i < count_; ++i) deepest = std::max(deepest, -problem_.b[at(i)]);
  return deepest;
}

/// The forces of the solution, of rows and tools.
PALPATE_INLINE void ContactRows::store_forces(std::span<ContactTool> tools) noexcept {
  pressing_force_.fill(0.0);
  for (ContactTool& tool : tools) {
    tool.force.setZero();
    tool.torque.setZero();
  }
  for (int i = 0; i < count_; ++i) {
    Contact& row = rows_[at(i)];
    Candidate& c = *candidate_[at(i)];
    c.force = row.force = problem_.lambda[at(i)];
    if (friction_.acts()) c.friction = row.friction = friction_.force(i);
    if (c.force == 0.0 && !c.grasped) c.history.known = 0;
    const Vector3 total = row.total();
    forces_.set(i, total);
    if (row.force == 0.0) continue;
    pressing_force_[at(row.tool)] += std::abs(row.force);
    ContactTool& tool = tools[at(row.tool)];
    tool.force += total;
    tool.torque += cross(row.arm, total);
  }
  forces_.pad(count_);
}

PALPATE_INLINE void ContactRows::apply(const TissueView& tissue, const Candidates& points, std::span<ContactTool> tools,
                                       SurfaceDisplacement& displacement) noexcept {
  displacement.clear();
  store_forces(tools);
  int loaded = count_;  // where a solution failed, there are no forces, and the compliance may not be finite
  while (loaded > 0 && problem_.lambda[at(loaded - 1)] == 0.0) --loaded;
  stored_.displace(count_, loaded, forces_, moved_);
  double longest = 0.0;
  for (int i = 0; i < count_; ++i) {
    Contact& row = rows_[at(i)];
    const Candidate& c = *candidate_[at(i)];
    row.point = row.rest - moved_[i];
    longest = std::max(longest, (row.point - c.point).squaredNorm());
    if (row.force == 0.0) continue;
    const Vector3 total = forces_[i];
    for (std::size_t a = 0; a < 3; ++a)
      if (row.weights[a] > 0.0) displacement.add(row.vertices[a], -row.weights[a] * total, slot_[at(row.vertices[a])]);
    if (const HalfSpacePoint& point = compliance_.half_space_point(c.slot); point.is_known()) {
      const Vector3 at_rest =
          tissue.has_half_space_map() ? Vector3(compliance_.map(c.slot).transpose() * total) : total;
      displacement.add_load({c.sample, point, c.area, row.point - row.rest, -at_rest}, points.samples()[c.sample]);
    }
  }
  for (const VertexForce& f : displacement.forces()) slot_[at(f.vertex)] = -1;
  longest_path_ = std::sqrt(longest);
  remaining_change_ = -1.0;
}

PALPATE_INLINE void ContactRows::place_points() noexcept {
  for (int i = 0; i < count_; ++i) candidate_[at(i)]->point = rows_[at(i)].point;
}

}}}  // namespace palpate::detail
