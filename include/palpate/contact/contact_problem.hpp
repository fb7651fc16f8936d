// Contact of rigid spheres, capsules and convex tools with a deformable surface, solved exactly in every tick.
#pragma once

#include <palpate/contact/detail/contact_rows.hpp>
#include <palpate/contact/detail/point_levels.hpp>
#include <palpate/contact/detail/proxy_motion.hpp>
#include <palpate/contact/force_accuracy.hpp>
#include <palpate/contact/grasp.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// All contacts of all tools with one tissue. Contact is enforced at material points of the surface, whose number
/// depends on the tool and its depth, not on the mesh (ContactSamples, PointLevels); where the surface has a
/// SubfacetCompliance, the force depends on the mesh as little. A sliding sphere reaches these points one after the
/// other, each with zero force at first, so the force has no jump at edges. Each tick linearises the distance between
/// sphere and deformed surface at the last proxy position (Ruspini's proxy on a deforming surface), solves the
/// Signorini problem on the contact compliance J C J^T exactly, and repeats while the force still changes. The rows of
/// that problem are the points that pressed last and those that the solution would let penetrate; rows are added until
/// no point penetrates. The coupling between proxy and device enters as n_i . n_j / k between contacts of one tool: the
/// stiffness rendered by the device is never more than k for any number of contacts, and the proxy never penetrates.
/// docs/contact.md has the equations, limits and figures. Work is bounded by `ContactParameters::capacity`, iterations,
/// rounds and candidates.
class ContactProblem {
 public:
  /// Errors above this part of a force are flagged.
  static constexpr double flagged_error = 0.1;
  /// Largest ContactParameters::capacity.
  static constexpr int maximum_capacity = 1024;

  /// Places the contact points for spheres of these radii. Allocates workspaces; for set-up.
  /// Throws bad_argument unless 0.4 <= sample_spacing <= 1, with less than one iteration or a capacity below one
  /// contact, and for an edge of the surface longer than 32 radii (ids: its vertices): the lattice of points ends
  /// there, and the sphere would fall through.
  ContactProblem(const ContactSurface& surface, const ToolRadii& radii, const ContactParameters& parameters = {});

  /// Finds the forces for the tools' new targets; updates proxy and force of every active tool. At most
  /// `maximum_tools` tools. Any TissueModel is a TissueView. Never allocates.
  Status solve(const TissueView& tissue, std::span<ContactTool> tools) noexcept;

  // The parts of `solve`, for tools that also touch other tissues: their targets may be moved between two `iterate`.
  Status begin(const TissueView& tissue, std::span<ContactTool> tools) noexcept;
  Status iterate(const TissueView& tissue, std::span<ContactTool> tools) noexcept {
    return iterate(tissue, tools, parameters_.maximum_iterations);
  }
  Status iterate(const TissueView& tissue, std::span<ContactTool> tools, int linearisations) noexcept;
  Status end(const TissueView& tissue, std::span<ContactTool> tools) noexcept;

  /// Continues on the surface of the same body after a cut, where vertices keep their numbers and there may be more.
  /// Forces, friction and grasps stay on the points that still exist, so that the next tick changes them only as much
  /// as the cut does. `fresh` was constructed for that surface with the same parameters; its workspaces are exchanged
  /// for the old ones. No allocation.
  void move_to(ContactProblem& fresh, const ContactSurface& surface) noexcept;

  /// Back to the state after construction: the next ticks are bitwise equal to the first ticks.
  void reset() noexcept;

  /// Coulomb's coefficient from the next tick on; without effect where it was zero at construction.
  void set_friction(double coefficient) noexcept { rows_.set_friction(coefficient); }

  /// Largest number of contacts.
  int capacity() const noexcept { return rows_.capacity(); }
  /// Rows of the last linearisation: points that press, and points that would have penetrated; some without force.
  std::span<const Contact> contacts() const noexcept { return rows_.contacts(); }
  /// The forces of the last tick on the vertices.
  std::span<const VertexForce> vertex_forces() const noexcept { return displacement_.forces(); }
  /// The same on the contact points. O(contacts).
  std::span<const PointForce> point_forces() noexcept;
  /// The closest point of the touchable surface as the forces of the last tick deform it. `distance` [m] is that of the
  /// resting surface. Visits the triangles that the forces may have moved there; no allocation.
  ContactSurface::Closest closest(const TissueView& tissue, const Vector3& position, double distance) noexcept;
  /// What `solve` returned for all tools does not include this: coarse_contact of one tool. For the end of a tick,
  /// after `force_error`.
  Status status_of(std::size_t t, const ContactTool& tool) const noexcept {
    return tool.active && coarse_[t] ? Status(StatusFlag::coarse_contact) : Status();
  }
  /// The share of a tool's contact force, 0 to 1, at points whose facets face away from it, at rest and deformed: they
  /// push it out of the body on the wrong side. Grasped points do not count. No allocation; O(contacts).
  double force_from_behind(const TissueView& tissue, std::size_t t) noexcept;
  /// The share at points of the rim beyond which the body goes on and cannot be touched, or within half of their
  /// spacing of it: of a tool over the rim, a part of the force is missing. No allocation; O(contacts).
  double force_on_rim(const TissueView& tissue, std::size_t t) const noexcept;
  /// How deep a tool presses the surface at rest: the mean over its contacts, weighted with their forces [m].
  double indentation(std::size_t t, const ContactTool& tool) const noexcept;
  /// Estimated error of the force of a tool in the last tick: from the mesh, as measured at set-up, from the linear
  /// model, and from what was omitted in the tick. The bound is infinite where nothing was measured, and while a column
  /// of the compliance is missing: what an assumed one does to the force has no bound. No allocation; O(contacts).
  ForceError force_error(const TissueView& tissue, std::size_t t, const ContactTool& tool) noexcept;
  /// Whether a tool had fewer points in the last tick than when it began to press: they suffice, or rows or room were
  /// missing.
  bool has_fewer_points(std::size_t t) const noexcept { return levels_.had_fewer(static_cast<int>(t)); }
  /// What the error of a force on a tool is relative to [N]: detail/contact_rows.hpp.
  double scale_of_force(std::size_t t, double force) const noexcept {
    return detail::force_scale(force, rows_.pressing_force(t));
  }
  /// Penetration of the deepest contact point that has no row because more points press than the capacity, relative to
  /// the deepest push. The force is too small by that part of the true force, or less. 0 when every point has a row.
  double missing_depth() const noexcept;
  /// Whether a tool grasps a point or a pad.
  bool is_holding(std::size_t tool) const noexcept { return grasps_[tool].holds_any(); }

 private:
  using Tools = detail::ProxyMotion::Tools;
  struct Violated {
    double gap;
    detail::Candidate* candidate;
  };
  static constexpr int maximum_rounds = 12;            // solutions of the contact problem per tick
  static constexpr int added_per_round = 16;           // rows, those of deepest penetration
  static constexpr double unconverged_change = 0.05;   // relative change of force that is left and is flagged
  static constexpr double growing = 0.005;             // the same where a change is larger than the one before
  static constexpr double first_change_safety = 10.0;  // factor on the change of force in the first linearisation
  static constexpr double estimate_safety = 1.75;      // factor on the estimate after one linearisation
  static constexpr double largest_feedback = 0.75;     // of the normals of two linearisations
  static constexpr int most_corrections = 3;           // steps with the same compliance in a linearisation
  static constexpr double largest_correction = 0.05;   // where more is estimated, another linearisation follows
  static constexpr double flagged_part = 0.1;          // of a force: a smaller part at bad places sets no flag
  static constexpr double violation = 1e-5;            // allowed penetration, relative to the dent there
  static constexpr double rounding = 1e-12;            // the same, relative to the radius: a tool that just touches

  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  static ContactParameters checked(const ContactParameters& p);
  inline Vector3 middle_of_print(std::size_t t) const noexcept;
  detail::Candidate* point_to_grasp(const TissueView& tissue, const ContactTool& tool, std::size_t t) noexcept;
  Status grasp(const TissueView& tissue, Tools tools) noexcept;
  bool pin_pads() noexcept;
  bool presses_beside_pad(std::size_t t) const noexcept;
  inline bool is_grasped(const ContactSurface& surface, const detail::Candidate& c) const noexcept;
  inline bool may_have_row(const detail::Candidate& c) const noexcept;
  inline void set_area(detail::Candidate& c) const noexcept;
  static detail::ContactSamples made_samples(const ContactSurface& surface, const ToolRadii& radii,
                                             const ContactParameters& p);
  inline void set_levels(Tools tools) noexcept;
  Status update_candidates(const TissueView& tissue, Tools tools) noexcept;
  std::array<double, maximum_tools> vertices_of_print(const ContactSurface& surface) const noexcept;
  void start_levels(const TissueView& tissue, Tools tools) noexcept;
  void prefetch(const TissueView& tissue) noexcept;
  Status balance(const TissueView& tissue, Tools tools) noexcept;
  void add_rows(const TissueView& tissue) noexcept;
  void solve_linearised(const TissueView& tissue, Tools tools, int iteration, Status& status) noexcept;
  void correct_normals(const TissueView& tissue, Tools tools, Status& status) noexcept;
  void gather_pressing(const TissueView& tissue, Tools tools) noexcept;
  inline std::array<bool, maximum_tools> are_near(Tools tools) const noexcept;
  void share_rows(Tools tools, const std::array<bool, maximum_tools>& is_near) noexcept;
  double depth_of(double work, double scale, const Vector3& force, const ContactTool& tool) const noexcept;
  double error_of_points(std::size_t t) const noexcept;
  bool presses(std::size_t t, int row) const noexcept;
  bool bends_coarse_elements(const ContactSurface& surface, std::size_t t, const ContactTool& tool) const noexcept;
  bool presses_edge(const ContactSurface& surface, std::size_t t, double longest) const noexcept;
  bool presses_coarse_facets(const ContactSurface& surface, std::size_t t, const ContactTool& tool,
                             bool measured) const noexcept;
  bool is_as_measured(const ContactSurface& surface) const noexcept;
  const ForceAccuracy* accuracy_of(const TissueView& tissue) const noexcept;
  ForceError error_without_force(const TissueView& tissue, const ContactTool& tool) const noexcept;
  double error_of_sphere(const ContactSurface& surface, const ForceAccuracy& accuracy, std::size_t t,
                         const ContactTool& tool) const noexcept;
  inline static double distance_from_support(const detail::LinearModelError& model, const Contact& c) noexcept;
  void add_model_errors(const ContactSurface& surface, std::size_t t, detail::SphereIndentation sphere, double scale,
                        ForceErrorParts& parts) const noexcept;
  inline void note_pressing(detail::Candidate& c) noexcept;
  void predict_normals(int iteration) noexcept;
  void add_violated(const TissueView& tissue, Tools tools, int& built) noexcept;
  void follow(const TissueView& tissue, Tools tools) noexcept;
  void set_outward(const ContactSurface& surface, Tools tools) noexcept;
  void note_forces_of_lifted(Tools tools) noexcept;
  void limit_feedback(bool converged, bool grows) noexcept;
  static double rest_of_changes(double before, double change, double rest) noexcept;
  bool has_converged(Tools tools, int iteration, double before, double& change) noexcept;

  ContactParameters parameters_;
  detail::SurfaceDisplacement displacement_, start_;  // now; where the last linearisation started
  detail::Candidates candidates_;
  detail::ContactRows rows_;
  std::vector<PointForce> on_points_;
  std::vector<detail::Candidate*> pressing_;  // those of the last linearisation
  std::vector<Violated> violated_;
  detail::ProxyMotion proxies_;
  detail::PointLevels levels_;
  std::array<Grasp, maximum_tools> grasps_{};
  int pressing_count_ = 0, violated_count_ = 0, rounds_left_ = 0;
  std::array<int, maximum_tools> pressing_of_{};  // per tool
  std::array<bool, maximum_tools> coarse_{};      // tools that press facets too coarse for them
  bool late_ = false;                             // a column of the compliance was missing in the last `solve`
  bool arrived_ = true;                           // proxies are at the solution of the last linearisation
  bool has_new_surface_ = false;                  // since the last tick
  std::array<bool, maximum_tools> is_near_{};     // tools with contact points near them
  double rest_of_change_ = 0.0;                   // relative change of force that is left
  double feedback_ = 0.0, most_feedback_ = largest_feedback;
  double of_lifted_ = 0.0;       // forces of tools that are gone, which are still on the tissue [N]
  double most_of_lifted_ = 0.0;  // of them, since the tools have gone
  double floor_ = 0.0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/contact_problem.ipp>
#endif
