// The contact points near the spheres, remembered from tick to tick.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/surface_displacement.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What a row was linearised with and what came of it, of the last linearisation and the one before.
struct NormalHistory {
  Vector3 used = Vector3::Zero(), used_before = Vector3::Zero(), made_before = Vector3::Zero();
  int known = 0;  ///< how many linearisations in a row, at most 2
};

/// A contact point near the sphere of one tool, as it was when last looked at.
struct Candidate {
  int sample = 0;
  int triangle = 0;
  int tool = 0;
  int row = -1;                      ///< of the contact problem, -1 when it has none
  int slot = -1;                     ///< where its compliance was remembered last
  bool facing = true;                ///< the sphere is on the outer side
  double gap = 0.0;                  ///< [m]
  double seen = 0.0;                 ///< travel of sphere and surface until then [m]
  double force = 0.0;                ///< of the last solution [N]
  Vector3 point = Vector3::Zero();   ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();  ///< unit, from the point to the sphere's centre
  double along = 0.0;                ///< where on a capsule's axis that centre lies [m]
  NormalHistory history;

  Vector3 friction = Vector3::Zero();  ///< of the last solution, on the tool [N]
  Vector3 anchor = Vector3::Zero();    ///< where the point clung to the tool after the last tick, tool's own frame [m]
  std::uint64_t stuck_tick = 0;        ///< the tick after which it did
  bool grasped = false;                ///< no point near a sphere, but one that is held

  /// Forgets what it carried.
  void lift() noexcept {
    force = 0.0;
    stuck_tick = 0;
    history.known = 0;
  }
};

/// All contact points that a sphere can reach within a tick, and some more, so that the list holds for a while: the way
/// of sphere and surface since then is summed up and the list made anew when the margin is used up (as neighbour lists
/// in molecular dynamics, Verlet 1967). A point is evaluated again only when that way could have closed its gap. The
/// search on the resting surface reaches as far as the surface has moved (SurfaceDisplacement::reach); a round over all
/// vertices, a few per tick, finds what moved farther. No allocation; work bounded by `maximum` and, when the
/// list is made anew, by the samples of all triangles in reach: each is looked at.
class Candidates {
 public:
  /// Places the samples `spacing` [m] apart; `capacity` is that of the contact problem. Allocates; for set-up.
  Candidates(const ContactSurface& surface, double spacing, int capacity);

  /// Of points in the list.
  int maximum() const noexcept { return static_cast<int>(items_.size()); }
  const ContactSamples& samples() const noexcept { return samples_; }
  std::span<Candidate> items() noexcept { return {items_.data(), static_cast<std::size_t>(count_)}; }
  bool has_any(int tool) const noexcept;
  void forget() noexcept { valid_ = false; }
  /// Back to the state after construction.
  void reset() noexcept;
  /// Whether the last update made another list: candidates are elsewhere in memory.
  bool is_new() const noexcept { return is_new_; }
  /// Whether the last list has no place for a force of the one before: its tool was lifted. The surface then springs
  /// back by an unknown amount, and the next update makes another list.
  bool has_lost_forces() const noexcept { return lost_forces_; }

  /// Goes on on the same body's surface after a cut: vertices have the same numbers, triangles and points need not.
  /// What lay on triangles that are gone does not press any more. `fresh` was made for that surface and gets the old
  /// samples. No allocation.
  void move_to(Candidates& fresh, const ContactSurface& surface) noexcept;
  /// Puts a candidate on the sample that lies where its own of another surface lay; false when there is none.
  bool move(Candidate& c, const ContactSamples& before, const ContactSurface& surface) const noexcept;

  /// Takes in what happened since the last tick: tools put elsewhere, lifted or set down, a moved resting surface.
  void begin_tick(const ContactSurface& surface, std::span<const ContactTool> tools) noexcept;
  /// The sphere of a tool is here now.
  void move_sphere(std::size_t t, const ContactTool& tool) noexcept;
  /// No point of the surface has moved farther than this.
  void move_surface(double distance) noexcept { surface_travel_ += distance; }

  /// Makes the list anew unless it still holds for another linearisation. degraded_model when there is no room for all
  /// that a sphere may reach.
  Status update(const TissueView& tissue, std::span<const ContactTool> tools,
                SurfaceDisplacement& displacement) noexcept;

  /// Whether sphere or surface may have moved since a candidate was looked at.
  bool is_stale(const Candidate& c) const noexcept { return travel(static_cast<std::size_t>(c.tool)) != c.seen; }
  /// At least the gap of a candidate now.
  double least_gap(const Candidate& c) const noexcept {
    return c.gap - (travel(static_cast<std::size_t>(c.tool)) - c.seen);
  }

  /// Evaluates a candidate at the present deformation and proxy.
  void evaluate(const TissueView& tissue, const ContactTool& tool, SurfaceDisplacement& displacement,
                Candidate& c) noexcept;
  /// Sets where a candidate's point is.
  inline void place(Candidate& c, const Vector3& point, const ContactTool& tool) const noexcept;

  /// Looks at the next few vertices of the round.
  void look_round(const TissueView& tissue, std::span<const ContactTool> tools,
                  SurfaceDisplacement& displacement) noexcept;

  /// Resting place of a sample [m].
  inline Vector3 rest(const ContactSurface& surface, int s) const noexcept;

 private:
  static constexpr int per_tick = 2;

  inline static double needed(const ContactTool& tool) noexcept;
  int triangle_of(const ContactSurface& surface, int sample) const noexcept;
  double travel(std::size_t tool) const noexcept { return travel_[tool] + surface_travel_; }
  void build(const TissueView& tissue, std::span<const ContactTool> tools, SurfaceDisplacement& displacement) noexcept;
  void keep_loaded(const TissueView& tissue, std::span<const ContactTool> tools,
                   SurfaceDisplacement& displacement) noexcept;
  bool is_loaded(int tool, int sample) const noexcept;
  void consider(const TissueView& tissue, const ContactTool& tool, int t, int triangle, int sample,
                SurfaceDisplacement& displacement) noexcept;
  bool faces_sphere(const TissueView& tissue, SurfaceDisplacement& displacement, const Candidate& c) const noexcept;

  ContactSamples samples_;
  std::vector<Candidate> items_, loaded_;  // loaded: of the list before
  int count_ = 0, loaded_count_ = 0;
  bool valid_ = false, is_new_ = false, lost_forces_ = false;
  std::uint64_t revision_ = 0;
  std::array<Vector3, maximum_tools> proxy_, axis_;
  std::array<bool, maximum_tools> was_active_{};
  std::array<double, maximum_tools> range_{}, built_{}, travel_{};  // range: gaps up to which the list was complete
  double surface_travel_ = 0.0;
  double reach_ = 0.0, far_ = 0.0, far_last_round_ = 0.0;
  int next_ = 0;  // vertex of the round
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/candidates.ipp>
#endif
