// The rows of the contact problem of a tick.
#pragma once

#include <palpate/contact/coulomb_friction.hpp>
#include <palpate/contact/detail/candidates.hpp>
#include <palpate/contact/detail/complementarity.hpp>
#include <palpate/contact/detail/row_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// What changes, depths and errors of a contact force are relative to: its length, or half of the sum of the normal
/// forces where that is more. In a hole or a fold the normal forces cancel, and what is left of them is no scale.
inline double force_scale(double force, double sum) noexcept {
  return std::max(force, 0.5 * sum);
}

/// Up to `capacity` candidates that press or might press, as rows of W lambda + b: adds and drops them, builds W from
/// the tissue's compliance, solves, and returns forces and displaced points. Nothing allocates after construction.
class ContactRows {
 public:
  /// Allocates workspaces; for set-up.
  ContactRows(int vertices, double friction, int capacity);

  /// Clears the compliance between points when the tissue's compliance has changed.
  void begin_tick(std::uint64_t compliance_revision) noexcept;
  void clear() noexcept;
  void forget_compliance() noexcept { compliance_.forget(); }
  /// Back to the state after construction.
  void reset() noexcept;
  /// Removes all rows and continues on a surface with more vertices, for which `fresh` was constructed.
  void move_to(ContactRows& fresh) noexcept;

  int capacity() const noexcept { return capacity_; }
  int count() const noexcept { return count_; }
  std::span<const Contact> contacts() const noexcept { return {rows_.data(), at(count_)}; }
  std::array<int, maximum_tools> count_by_tool() const noexcept;
  /// Those with force.
  std::array<int, maximum_tools> count_pressing() const noexcept;
  Candidate& candidate(int row) noexcept { return *candidate_[at(row)]; }
  const Candidate& candidate(int row) const noexcept { return *candidate_[at(row)]; }
  /// Whether the compliance of the point of a row depends on the area that it stands for.
  bool has_area(int row) const noexcept { return compliance_.half_space_point(candidate(row).slot).is_known(); }
  /// Whether the body at the point of a row is the half-space that its compliance assumes.
  bool is_known(int row) const noexcept {
    const HalfSpacePoint& point = compliance_.half_space_point(candidate(row).slot);
    return (point.is_known() || point.is_fixed) && !point.is_disturbed;
  }
  /// HalfSpacePoint::edge_nearness of the point of a row.
  double edge_nearness(int row) const noexcept {
    return compliance_.half_space_point(candidate(row).slot).edge_nearness;
  }
  /// HalfSpacePoint::bending_error of the point of a row.
  double bending_error(int row) const noexcept {
    return compliance_.half_space_point(candidate(row).slot).bending_error;
  }
  /// Whether the body at the point of a row is too thin: for facets that are longer, which is why the point has no
  /// half-space, or for the area that the point stands for, when what is below takes most of its own compliance away.
  /// After `build`.
  bool is_on_thin_body(int row) const noexcept {
    const HalfSpacePoint& point = compliance_.half_space_point(candidate(row).slot);
    return remaining_[at(row)] < 0.3 || (point.is_disturbed && !point.is_known() && !point.is_fixed);
  }
  /// How many points of equal area the print of every tool has, from the forces f of its rows and their normals n:
  /// 9/8 |sum f n|^2 / sum f^2, which is their number for the pressure of Hertz. Points that begin to press, or have
  /// almost faded out, count little. Of a tool between two surfaces it is about the number of points on one of them.
  std::array<double, maximum_tools> points_of_print() const noexcept;

  /// Before a point is added: its slip counts from where the tool stuck or slipped to in the last tick, as that of the
  /// nearest point that pressed then. Otherwise a tool that passes from point to point would slide without friction in
  /// the ticks between.
  void inherit_friction(const ContactTool& tool, Candidate& c) const noexcept;
  /// The caller guarantees that there is room.
  void add(const TissueView& tissue, const Candidates& candidates, Candidate& c) noexcept;
  /// Drops rows without force to make room; W must then be rebuilt. False when all rows have force.
  bool drop_idle(const TissueView& tissue, const Candidates& candidates) noexcept;
  /// Requests the compliance columns of all vertices that carry rows.
  Status require_columns(const TissueView& tissue) noexcept;

  /// Rows `first` and later of W = J C J^T plus the coupling and `floor` [m/N], and of b = gap at the target without
  /// contact force.
  void build(const TissueView& tissue, const Candidates& points, std::span<const ContactTool> tools, double floor,
             int first) noexcept;
  /// Solves for the normal forces with the present friction forces, after `build` from row `first`. False when the
  /// iteration was stopped early.
  bool solve(int first) noexcept;
  /// Solves for the friction forces and for the normal forces in turn (Panagiotopoulos 1975),
  /// until both stay or the bound of the work is reached; further linearisations and ticks continue the iteration.
  /// Stopped too early, it may alternate from tick to tick between two states, since normals follow the unfinished
  /// forces. False when a solution was stopped early.
  bool slide() noexcept;
  /// Whether the last turn of slide changed the normal forces by less than a hundredth of the largest.
  bool has_converged() const noexcept { return !(alternation_change_ > unconverged_change); }
  bool has_friction() const noexcept { return friction_.acts(); }
  void set_friction(double coefficient) noexcept { friction_.set_coefficient(coefficient); }
  /// Sum of force times penetration without contact force, over the rows of a tool: twice the energy of its contact, if
  /// no other tool presses [J].
  double push_work(int tool) const noexcept;
  /// The part of one row [J].
  double push_work_of_row(int i) const noexcept { return -(problem_.lambda[at(i)] * problem_.b[at(i)]); }
  /// Sum of the normal forces on a tool in the last solution applied [N].
  double pressing_force(std::size_t tool) const noexcept { return pressing_force_[tool]; }
  /// Largest force_scale of all tools [N].
  double largest_force_scale(std::span<const ContactTool> tools) const noexcept;
  /// Penetration without contact force, at the deepest row built [m].
  double deepest_push() const noexcept;

  /// Writes the solution to rows, vertices and tools. Candidates get their forces; they stay where they are.
  void apply(const TissueView& tissue, const Candidates& points, std::span<ContactTool> tools,
             SurfaceDisplacement& displacement) noexcept;
  /// The longest displacement of a row's point from where its candidate is to the solution [m].
  double longest_path() const noexcept { return longest_path_; }
  /// Moves the candidates of the rows to the solution.
  void place_points() noexcept;
  /// Estimated change of the tools' forces by another linearisation, relative to the largest force: that of the contact
  /// forces when their normals follow the solution, and the gaps at the solution relative to the deepest push. To be
  /// called after `apply`. Infinite for tools other than spheres, with friction and for grasps: not known.
  /// No allocation; O(rows) for the first call after `apply`.
  double remaining_change(std::span<const ContactTool> tools) noexcept;
  /// A step from the solution with the same W, as in a chord method, after `remaining_change`, where that is finite:
  /// forces act along the normals at the solution, and gaps are distances there. `apply` must follow. False when the
  /// iteration was stopped early. No allocation; O(rows^2).
  bool correct_normals(std::span<const ContactTool> tools) noexcept;
  /// At the end of a tick: a point that slipped gets a new stick anchor at its present place; one that sticks keeps its
  /// anchor, as do all where the forces have not settled.
  void stick(std::span<const ContactTool> tools) noexcept;

 private:
  static constexpr int least_alternations = 4, maximum_alternations = 16;  // turns of slide
  static constexpr int alternation_work = 25'000;                          // turns times rows^2
  static constexpr int full_alternations = 6;  // then half steps: with much friction, full ones may go in a circle
  static constexpr double alternation_tolerance = 1e-4;
  static constexpr double unconverged_change = 0.01;
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  inline bool sticks(const Candidate& c) const noexcept;
  inline static void reach(const ContactTool& tool, const Candidate& c, Contact& row) noexcept;
  void set_friction(const ContactTool& tool, int i) noexcept;
  double estimate_change(std::span<const ContactTool> tools) noexcept;
  RowCompliance::Coupling coupling_of(const ContactTool& tool) const noexcept {
    return {tool.compliance + floor_, tool.rotational_compliance};
  }
  void store_compliance(const TissueView& tissue, const Candidates& points, int i) noexcept;
  void build_row(const ContactTool& tool, int i) noexcept;
  /// Displacement of the point in a row per force on that in another, whose slot is not larger [m/N]. `workspace`: for
  /// two rows at one point.
  PALPATE_ALWAYS_INLINE const Matrix3& between(const TissueView& tissue, const Candidates& points, int i, int j,
                                               Matrix3& workspace) noexcept {
    const int p = candidate_[at(i)]->slot, q = candidate_[at(j)]->slot;
    const Matrix3& compliance = compliance_(tissue, points, p, q);
    return p == q || has_copies_ ? with_self_compliance(tissue, points, i, j, compliance, workspace) : compliance;
  }
  const Matrix3& with_self_compliance(const TissueView& tissue, const Candidates& points, int i, int j,
                                      const Matrix3& compliance, Matrix3& workspace) noexcept;
  inline void update_gaps() noexcept;
  void store_forces(std::span<ContactTool> tools) noexcept;

  int capacity_, count_ = 0;
  ComplementarityProblem problem_;
  CoulombFriction friction_;
  std::vector<double> free_gap_, pressed_;  // pressed: normal forces that bound the friction forces
  double floor_ = 0.0, longest_path_ = 0.0;
  double alternation_change_ = 0.0;  // of a normal force in the last turn of slide, relative to the largest one
  std::uint64_t tick_ = 0;
  std::array<std::uint64_t, maximum_tools> pressed_tick_{};  // the last one in which a tool had friction
  bool has_copies_ = false;                                  // different vertices may be at the same place
  PointCompliance compliance_;
  std::vector<Contact> rows_;
  std::vector<Candidate*> candidate_;
  RowCompliance stored_;
  RowVectors forces_, moved_;        // total forces, and displacements by them
  std::vector<double> in_axes_;      // a row of the compliance, with friction
  std::vector<double> remaining_;    // compliance of a point by its own force, relative to that on a half-space
  std::vector<Vector3> redirected_;  // by remaining_change: change of a row's force by its new normal
  std::array<Vector3, maximum_tools> redirected_of_tool_{};
  std::array<double, maximum_tools> pressing_force_{};
  double remaining_change_ = -1.0;  // negative: not known
  std::vector<int> vertices_;
  std::vector<int> slot_;  // scratch per vertex: -1 between calls
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/contact_rows.ipp>
#include <palpate/contact/detail/contact_rows_directions.ipp>
#endif
