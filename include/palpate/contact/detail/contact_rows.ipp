// Definitions of contact_rows.hpp.
#pragma once

#include <palpate/contact/detail/contact_rows.hpp>
#include <palpate/contact/detail/contact_rows_friction.ipp>  // inline functions

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ContactRows::ContactRows(int vertices, double friction, int capacity)
    : capacity_(capacity),
      problem_(capacity),
      friction_(friction, capacity),
      free_gap_(at(capacity)),
      pressed_(at(capacity)),
      compliance_(capacity),
      rows_(at(capacity)),
      candidate_(at(capacity)),
      response_(problem_.stride() * at(capacity)),
      remaining_(at(capacity)),
      redirected_(at(capacity)),
      redirected_path_(at(capacity)),
      shift_(at(capacity)),
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

/// Displacement of two points, each per force on the other along the normal of its row, m and n; their compliance is c,
/// 3 x 3. Returns its component along the own normal. Written out so that it stays in registers: half of the work of a
/// tick with many contacts is done here.
inline double ContactRows::set_responses(const double* c, const double* m, const double* n, double* of_n,
                                         double* of_m) noexcept {
  const double x = c[0] * n[0] + c[3] * n[1] + c[6] * n[2];
  const double y = c[1] * n[0] + c[4] * n[1] + c[7] * n[2];
  const double z = c[2] * n[0] + c[5] * n[1] + c[8] * n[2];
  of_n[0] = x, of_n[1] = y, of_n[2] = z;
  of_m[0] = c[0] * m[0] + c[1] * m[1] + c[2] * m[2];
  of_m[1] = c[3] * m[0] + c[4] * m[1] + c[5] * m[2];
  of_m[2] = c[6] * m[0] + c[7] * m[1] + c[8] * m[2];
  return m[0] * x + m[1] * y + m[2] * z;
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

/// Row i of W and the responses that belong to it.
inline void ContactRows::build_row(const TissueView& tissue, const Candidates& points, const ContactTool& tool,
                                   int i) noexcept {
  const Contact& ci = rows_[at(i)];
  const int p = candidate_[at(i)]->slot;
  const bool rotates = tool.rotational_compliance > 0.0;
  Matrix3 same;
  const double* const m = ci.normal.data();
  double *column = &problem_.w(0, i), *row = &problem_.w(i, 0);
  Vector3 *on_j = &response(i, 0), *on_i = &response(0, i);
  const std::size_t stride = problem_.stride();
  for (int j = 0; j <= i; ++j, ++on_j, on_i += stride, row += stride) {
    const Contact& cj = rows_[at(j)];
    const int q = candidate_[at(j)]->slot;
    const double* const n = cj.normal.data();
    double w = p >= q ? set_responses(between(tissue, points, i, j, same).data(), m, n, on_j->data(), on_i->data())
                      : set_responses(between(tissue, points, j, i, same).data(), n, m, on_i->data(), on_j->data());
    if (ci.tool == cj.tool) w += (tool.compliance + floor_) * ci.normal.dot(cj.normal);
    if (rotates && ci.tool == cj.tool)
      w += tool.rotational_compliance * cross(ci.arm, ci.normal).dot(cross(cj.arm, cj.normal));
    column[j] = *row = w;
  }
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
    remaining_[at(i)] = 1.0;
    problem_.lambda[at(i)] = 1.0;  // it presses, or would penetrate
    shift_[at(i)].setZero();
    Contact& ci = rows_[at(i)];
    const ContactTool& tool = tools[at(ci.tool)];
    problem_.bilateral[at(i)] = ci.grasped;
    reach(tool, *candidate_[at(i)], ci);
    problem_.b[at(i)] = free_gap_[at(i)] = ci.normal.dot(tool.target - ci.rest) + ci.offset;
    build_row(tissue, points, tool, i);
    if (friction_.acts()) build_friction(tissue, points, tool, i);
  }
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

/// The point of row i under the normal forces of the first `pressing` rows [m].
inline Vector3 ContactRows::moved_point(int i, int pressing) const noexcept {
  const double *response = this->response(i, 0).data(), *force = problem_.lambda.data();
  double even[3] = {}, odd[3] = {};  // independent sums, for speed
  int j = 0;
  for (; j + 2 <= pressing; j += 2, response += 6)
    for (int c = 0; c < 3; ++c) {
      even[c] += force[j] * response[c];
      odd[c] += force[j + 1] * response[3 + c];
    }
  if (j < pressing)
    for (int c = 0; c < 3; ++c) even[c] += force[j] * response[c];
  return rows_[at(i)].rest - shift_[at(i)] - Vector3(even[0] + odd[0], even[1] + odd[1], even[2] + odd[2]);
}

PALPATE_INLINE void ContactRows::apply(const TissueView& tissue, const Candidates& points, std::span<ContactTool> tools,
                                       SurfaceDisplacement& displacement) noexcept {
  displacement.clear();
  pressing_force_.fill(0.0);
  for (ContactTool& tool : tools) {
    tool.force.setZero();
    tool.torque.setZero();
  }
  if (friction_.acts()) store_friction(tools);
  int pressing = count_;  // where a solution failed, there are no forces, and the compliance may not be finite
  while (pressing > 0 && problem_.lambda[at(pressing - 1)] == 0.0) --pressing;
  double longest = 0.0;
  for (int i = 0; i < count_; ++i) {
    Contact& row = rows_[at(i)];
    Candidate& c = *candidate_[at(i)];
    c.force = row.force = problem_.lambda[at(i)];
    if (friction_.acts()) c.friction = row.friction = friction_.force(i);
    if (c.force == 0.0 && !c.grasped) c.history.known = 0;
    row.point = moved_point(i, pressing);
    if (friction_.acts()) row.point -= friction_.displacement(i) - coupling_displacement(tools[at(row.tool)], row);
    longest = std::max(longest, (row.point - c.point).squaredNorm());
    if (row.force == 0.0) continue;
    pressing_force_[at(row.tool)] += std::abs(row.force);
    ContactTool& tool = tools[at(row.tool)];
    const Vector3 total = friction_.acts() ? row.total() : Vector3(row.force * row.normal);
    tool.force += total;
    tool.torque += cross(row.arm, total);
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

}}  // namespace palpate
