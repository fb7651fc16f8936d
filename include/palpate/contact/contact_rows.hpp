// The rows of the contact problem of a tick.
#pragma once

#include <palpate/contact/candidates.hpp>
#include <palpate/contact/complementarity.hpp>
#include <palpate/contact/coulomb_friction.hpp>
#include <palpate/contact/point_compliance.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Up to `Capacity` candidates that press or might, as rows of W lambda + b: adds and drops them, builds W from the
/// tissue's compliance, solves, and hands forces and displaced points back. Nothing allocates after construction.
template <int Capacity>
class ContactRows {
 public:
  using Displacement = SurfaceDisplacement<3 * Capacity>;

  /// Allocates workspaces; for set-up.
  ContactRows(int vertices, double friction) : friction_(friction), slot_(static_cast<std::size_t>(vertices), -1) {}

  /// Forgets the compliance between points when the tissue's has changed.
  void begin_tick(std::uint64_t compliance_revision) noexcept {
    compliance_.begin_tick(compliance_revision);
    ++tick_;
  }
  void clear() noexcept {
    count_ = 0;
    compliance_.begin_rows();
  }
  /// Without rows, on a surface with more vertices, that `fresh` was made for.
  void move_to(ContactRows& fresh) noexcept {
    clear();
    compliance_.forget();
    slot_.swap(fresh.slot_);
  }

  int count() const noexcept { return count_; }
  std::span<const Contact> contacts() const noexcept { return {rows_.data(), at(count_)}; }
  Candidate& candidate(int row) noexcept { return *candidate_[at(row)]; }

  /// There is always room: the caller has seen to it.
  void add(const ContactSurface& surface, const Candidates<Capacity>& candidates, Candidate& c) noexcept {
    c.row = count_;
    c.slot = compliance_.slot_of(c.sample, c.slot);
    const ContactSample& sample = candidates.samples()[c.sample];
    candidate_[at(count_)] = &c;
    Contact& row = rows_[at(count_++)];
    row.tool = c.tool;
    row.vertices = sample.vertices;
    row.weights = sample.weights;
    row.normal = c.normal;
    row.rest = candidates.rest(surface, c.sample);
    row.point = c.point;
    row.force = c.force;
    row.grasped = c.grasped;
  }

  /// Rows without force make room; W has to be built anew. False when there are none.
  bool drop_idle() noexcept {
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
      c.slot = compliance_.slot_of(c.sample, c.slot);
      candidate_[at(kept)] = &c;
      rows_[at(kept++)] = rows_[at(i)];
    }
    count_ = kept;
    return true;
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

  /// Rows `first` and later of W = J C J^T plus the coupling and `floor` [m/N], and of b = gap at the target without
  /// contact force.
  template <TissueModel Tissue>
  void build(const Tissue& tissue, const ContactSamples& samples, std::span<const ContactTool> tools, double floor,
             int first) noexcept {
    floor_ = floor;
    problem_.resize(count_);
    for (int i = first; i < count_; ++i) {
      problem_.lambda[i] = 1.0;  // it presses, or would sink in
      Contact& ci = rows_[at(i)];
      const ContactTool& tool = tools[at(ci.tool)];
      problem_.bilateral[at(i)] = ci.grasped;
      reach(tool, *candidate_[at(i)], ci);
      problem_.b[i] = free_gap_[at(i)] = ci.normal.dot(tool.target - ci.rest) + ci.offset;
      const bool turns = tool.turning_compliance > 0.0;
      for (int j = 0; j <= i; ++j) {
        const Contact& cj = rows_[at(j)];
        double w = set_responses(tissue, samples, i, j);
        if (ci.tool == cj.tool) w += (tool.compliance + floor) * ci.normal.dot(cj.normal);
        if (turns && ci.tool == cj.tool)
          w += tool.turning_compliance * ci.arm.cross(ci.normal).dot(cj.arm.cross(cj.normal));
        problem_.w(i, j) = problem_.w(j, i) = w;
      }
      if (friction_.acts()) build_friction(tissue, samples, tool, i);
    }
    if (friction_.acts()) friction_.press(count_, pressing_before());
  }

  /// Presses: with the drags as they are. False when the forces are a cut-off answer.
  bool solve() noexcept {
    if (!friction_.acts()) return problem_.solve();
    for (int i = 0; i < count_; ++i) problem_.b[i] = free_gap_[at(i)] + rows_[at(i)].normal.dot(friction_.moved(i));
    const bool solved = problem_.solve();
    friction_.press(count_, pressing());
    return solved;
  }
  /// Drags, and presses once more: each exact for the other (Panagiotopoulos 1975); linearisations and ticks go on with
  /// it. False when the forces are a cut-off answer.
  bool rub() noexcept {
    friction_.solve(count_);
    friction_.press(count_, pressing());
    return solve();
  }
  bool has_friction() const noexcept { return friction_.acts(); }
  /// How far the tools would go in without contact force, at the deepest row built [m].
  double deepest_push() const noexcept { return std::max(0.0, -problem_.b.minCoeff()); }

  /// Hands the answer to points, vertices and tools.
  void apply(std::span<ContactTool> tools, Displacement& displacement, Candidates<Capacity>& candidates) noexcept {
    displacement.clear();
    for (ContactTool& tool : tools) {
      tool.force.setZero();
      tool.torque.setZero();
    }
    if (friction_.acts()) note_drags(tools);
    double largest = 0.0;
    for (int i = 0; i < count_; ++i) {
      Contact& row = rows_[at(i)];
      row.force = problem_.lambda[i];
      if (friction_.acts()) row.friction = friction_.row(i).drag;
      Vector3 point = row.rest;
      for (int j = 0; j < count_; ++j)
        if (problem_.lambda[j] != 0.0) point.noalias() -= problem_.lambda[j] * response_[at(i)][at(j)];
      if (friction_.acts()) point -= friction_.moved(i) - sprung(tools[at(row.tool)], row);
      largest = std::max(largest, (point - row.point).squaredNorm());
      row.point = point;
      if (row.force == 0.0) continue;
      ContactTool& tool = tools[at(row.tool)];
      const Vector3 total = friction_.acts() ? row.total() : Vector3(row.force * row.normal);
      tool.force += total;
      tool.torque += row.arm.cross(total);
      for (std::size_t a = 0; a < 3; ++a)
        if (row.weights[a] > 0.0)
          displacement.add(row.vertices[a], -row.weights[a] * total, slot_[at(row.vertices[a])]);
    }
    for (const VertexForce& f : displacement.forces()) slot_[at(f.vertex)] = -1;
    candidates.move_surface(2.0 * std::sqrt(largest));
    for (int i = 0; i < count_; ++i) {
      Candidate& c = *candidate_[at(i)];
      c.force = rows_[at(i)].force;
      c.friction = rows_[at(i)].friction;
      if (c.grasped) {
        c.point = rows_[at(i)].point;
        continue;
      }
      candidates.place(c, rows_[at(i)].point, tools[at(c.tool)]);
      if (c.force == 0.0) c.history.known = 0;
    }
  }

  /// At the end of a tick: what slipped clings where it is now; what sticks keeps its place.
  void cling(std::span<const ContactTool> tools) noexcept {
    if (!friction_.acts()) return;
    for (int i = 0; i < count_; ++i) {
      Candidate& c = *candidate_[at(i)];
      if (c.grasped || !(c.force > 0.0)) continue;
      const bool sticks = clings(c) && c.friction.norm() < (1.0 - 1e-6) * friction_.coefficient() * c.force;
      const ContactTool& tool = tools[at(c.tool)];
      if (!sticks) c.anchor = tool.rotation.transpose() * (c.point - tool.proxy);
      c.clung = tick_;
    }
  }

 private:
  bool clings(const Candidate& c) const noexcept { return c.clung != 0 && c.clung + 1 == tick_; }

  /// Where the tool touches a row's point.
  static void reach(const ContactTool& tool, const Candidate& c, Contact& row) noexcept {
    if (c.grasped) {
      row.arm = tool.rotation * c.anchor;
      row.offset = row.normal.dot(tool.target_rotation * c.anchor);
      return;
    }
    row.arm = -tool.radius * row.normal;
    row.offset = -tool.radius;
    if (c.along == 0.0) return;
    row.arm += c.along * tool.axis();
    row.offset += c.along * row.normal.dot(tool.target_rotation * tool.own_axis);
  }

  auto pressing() const noexcept {
    return [this](int i) { return problem_.lambda[i]; };
  }
  /// The forces of the solution before, as far as rows have been in one.
  auto pressing_before() const noexcept {
    return [this](int i) { return candidate_[at(i)]->force; };
  }
  /// Row i of what friction needs to know.
  template <TissueModel Tissue>
  void build_friction(const Tissue& tissue, const ContactSamples& samples, const ContactTool& tool, int i) noexcept {
    const Candidate& c = *candidate_[at(i)];
    const Contact& ci = rows_[at(i)];
    const Vector3 drift = tool.target + tool.target_rotation * c.anchor - ci.rest;
    const bool holds = !c.grasped && clings(c);
    friction_.row(i) = {ci.normal, 0.0, drift, holds ? c.friction : Vector3::Zero(), holds};
    for (int j = 0; j <= i; ++j) {
      const Contact& cj = rows_[at(j)];
      Matrix3 w = between(tissue, samples, i, j);
      if (ci.tool == cj.tool)
        w.diagonal().array() += tool.compliance + floor_ + tool.turning_compliance * ci.arm.dot(cj.arm);
      if (ci.tool == cj.tool && tool.turning_compliance > 0.0)
        w -= tool.turning_compliance * cj.arm * ci.arm.transpose();
      friction_.set(i, j, w);
    }
  }
  /// The compliance between two rows' points.
  template <TissueModel Tissue>
  Matrix3 between(const Tissue& tissue, const ContactSamples& samples, int i, int j) noexcept {
    const int p = candidate_[at(i)]->slot, q = candidate_[at(j)]->slot;
    return p >= q ? compliance_(tissue, samples, p, q) : Matrix3(compliance_(tissue, samples, q, p).transpose());
  }
  /// How far the couplings give way to the drags where a tool touches; the rest of CoulombFriction::moved is tissue.
  static Vector3 sprung(const ContactTool& tool, const Contact& row) noexcept {
    return tool.drag_way + tool.drag_turn.cross(row.arm);
  }
  void note_drags(std::span<ContactTool> tools) const noexcept {
    for (ContactTool& tool : tools) {
      tool.drag_way.setZero();
      tool.drag_turn.setZero();
    }
    for (int j = 0; j < count_; ++j) {
      const Contact& row = rows_[at(j)];
      ContactTool& tool = tools[at(row.tool)];
      tool.drag_way += (tool.compliance + floor_) * friction_.row(j).drag;
      tool.drag_turn += tool.turning_compliance * row.arm.cross(friction_.row(j).drag);
    }
  }

  /// Displacement of two rows' points per force on the other. Returns the part of it along the own normal. Written out
  /// so that it stays in registers: half of the work of a tick with many contacts is here.
  template <TissueModel Tissue>
  double set_responses(const Tissue& tissue, const ContactSamples& samples, int i, int j) noexcept {
    const int p = candidate_[at(i)]->slot, q = candidate_[at(j)]->slot;
    if (p < q) return set_responses(tissue, samples, j, i);
    const Matrix3& c = compliance_(tissue, samples, p, q);
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

  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  static constexpr auto capacity = static_cast<std::size_t>(Capacity);
  ComplementarityProblem<Capacity> problem_;
  CoulombFriction<Capacity> friction_;
  std::array<double, capacity> free_gap_{};
  double floor_ = 0.0;
  std::uint64_t tick_ = 0;
  PointCompliance<Capacity> compliance_;
  std::array<Contact, capacity> rows_{};
  std::array<Candidate*, capacity> candidate_{};
  std::array<std::array<Vector3, capacity>, capacity> response_{};  // of a row's point to unit force on another
  std::array<int, 3 * capacity> vertices_{};
  std::vector<int> slot_;  // scratch per vertex: -1 between calls
  int count_ = 0;
};

}}  // namespace palpate
