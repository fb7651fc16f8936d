// Rigid spheres and capsules against a deformable surface, solved exactly in every tick.
#pragma once

#include <palpate/contact/detail/contact_rows.hpp>
#include <palpate/contact/detail/proxy_motion.hpp>
#include <palpate/contact/grasp.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// All contacts of all tools with one tissue. The surface is held off the sphere at material points: vertices, and a
/// lattice on edges longer than `sample_spacing` radii. Points fixed in the material meet a sliding sphere one after
/// the other, each with zero force at first, so the force has no jump at edges. Each tick linearises the distance
/// between sphere and deformed surface at the last proxy position (Ruspini's proxy on a deforming surface), solves the
/// Signorini problem on the contact compliance J C J^T exactly, and repeats while the force still changes. Rows of that
/// problem are the points that pressed last and those the answer would let sink in, added until there are none. The
/// coupling between proxy and device enters as n_i . n_j / k between contacts of one tool: the device never feels more
/// than k, however many contacts there are, and the proxy never sinks in. docs/contact.md has the law, its limits and
/// figures. Work is bounded by `ContactParameters::capacity`, iterations, rounds and candidates.
class ContactProblem {
 public:
  /// The most that ContactParameters::capacity may be.
  static constexpr int maximum_capacity = 1024;

  /// Places the contact points for spheres of at least `smallest_radius` [m]. Allocates workspaces; for set-up.
  /// Throws bad_argument unless 0.4 <= sample_spacing <= 1, there is at least one iteration and room for a contact, and
  /// for an edge of the surface longer than 32 radii (ids: its vertices): the lattice of points ends there, and the
  /// sphere would fall through.
  ContactProblem(const ContactSurface& surface, double smallest_radius, const ContactParameters& parameters = {});

  /// Finds the forces for the tools' new targets; updates proxy and force of every active tool. At most
  /// `maximum_tools` tools. Any TissueModel is a TissueView. Never allocates.
  Status solve(const TissueView& tissue, std::span<ContactTool> tools) noexcept;

  /// Goes on on the same body's surface after a cut, where vertices keep their numbers and there may be more. Forces,
  /// friction and grasps stay on the points that are still there, so that the next tick changes them by as much as the
  /// cut does. `fresh` was made for that surface with the same parameters; its workspaces are exchanged for the old
  /// ones. No allocation.
  void move_to(ContactProblem& fresh, const ContactSurface& surface) noexcept;

  /// Back to the state after construction: the next ticks give the bits that the first ticks gave.
  void reset() noexcept;

  /// How many contacts there is room for.
  int capacity() const noexcept { return rows_.capacity(); }
  /// Rows of the last linearisation: what presses, and what would have sunk in without; some without force.
  std::span<const Contact> contacts() const noexcept { return rows_.contacts(); }
  /// The forces of the last tick on the vertices.
  std::span<const VertexForce> vertex_forces() const noexcept { return displacement_.forces(); }
  /// Whether a contact point is near a tool's sphere.
  bool is_near(int tool) const noexcept { return candidates_.has_any(tool); }
  /// Whether a tool holds a point.
  bool is_holding(std::size_t tool) const noexcept { return grasps_[tool].sample >= 0; }

 private:
  using Tools = ProxyMotion::Tools;
  struct Violated {
    double gap;
    Candidate* candidate;
  };
  static constexpr int maximum_rounds = 12;   // solutions of the contact problem per tick
  static constexpr int added_per_round = 16;  // rows, the deepest ones
  static constexpr double unsettled = 0.05;   // relative change of force in the last linearisation that is flagged
  static constexpr double violation = 1e-5;   // how far a point may sink in, of the deepest push

  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  static ContactParameters checked(const ContactParameters& p);
  void grasp(const TissueView& tissue, Tools tools) noexcept;
  inline bool is_grasped(const Candidate& c) const noexcept;
  void prefetch(const TissueView& tissue) noexcept;
  Status solve_linearised(const TissueView& tissue, Tools tools, int iteration) noexcept;
  void gather_pressing(Tools tools) noexcept;
  inline void note_pressing(Candidate& c) noexcept;
  void predict_normals(int iteration) noexcept;
  bool add_violated(const TissueView& tissue, Tools tools, int& built) noexcept;
  void follow(Tools tools) noexcept;

  ContactParameters parameters_;
  SurfaceDisplacement displacement_;
  Candidates candidates_;
  ContactRows rows_;
  std::vector<Candidate*> pressing_;  // in the last linearisation
  std::vector<Violated> violated_;
  ProxyMotion proxies_;
  std::array<Grasp, maximum_tools> grasps_{};
  int pressing_count_ = 0, violated_count_ = 0, rounds_left_ = 0;
  bool arrived_ = true;  // at the answer of the last linearisation
  double feedback_ = 0.0;
  double floor_ = 0.0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/contact_problem.ipp>
#endif
