// The contact points near the spheres, kept from tick to tick.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/contact/detail/candidate_list.hpp>
#include <palpate/contact/detail/surface_displacement.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// All contact points that a sphere can reach within a tick, and some more, so that the list stays valid for a while:
/// the path of sphere and surface since then is accumulated, and the list is rebuilt when the margin is used up (as
/// neighbour lists in molecular dynamics, Verlet 1967). While the last part of the margin is used up, the next list is
/// built in parts, so that no tick has all of that work; leaps have it at once. A point is evaluated again only when
/// that path could have closed its gap. The search on the resting surface reaches as far as the surface has moved
/// (SurfaceDisplacement::reach); where a tissue that moves knows how the surface is deformed, the search is on that
/// surface (ExpectedSurface). A list has the points of one level per tool and of all further levels; where a finer
/// level is needed, the list is rebuilt. A scan over all vertices, a few per tick, finds what moved farther than the
/// search reaches. No allocation; work bounded by `maximum` and, when the list is rebuilt at once, by the samples of
/// all triangles in reach: each is evaluated.
class Candidates {
 public:
  /// Takes the samples of a surface. `capacity` is that of the contact problem. `subfacet`: null where points have only
  /// the compliance of the mesh. Allocates; for set-up.
  Candidates(ContactSamples samples, std::shared_ptr<const SubfacetCompliance> subfacet, int capacity);

  static constexpr std::size_t most_pinned = 8 * maximum_tools;  ///< vertices of pads

  /// Largest number of points in the list.
  int maximum() const noexcept { return list_.points.maximum(); }
  const ContactSamples& samples() const noexcept { return samples_; }
  /// Null where points have only the compliance of the mesh.
  const SubfacetCompliance* subfacet() const noexcept { return subfacet_.get(); }
  /// The material point of a candidate.
  const ContactSample& sample_of(const Candidate& c) const noexcept { return samples_[c.sample]; }
  /// As a point of a half-space. Unknown without a SubfacetCompliance, and for points that depend on a pinned vertex.
  HalfSpacePoint half_space_point(int sample) const noexcept {
    if (!subfacet_ || depends_on_pad(samples_[sample])) return {};
    return subfacet_->point(samples_[sample], samples_.normal(sample));
  }
  /// Whether that point is known; costs less than the point.
  bool knows_half_space(int sample) const noexcept {
    return subfacet_ && !depends_on_pad(samples_[sample]) && subfacet_->knows(samples_[sample]);
  }
  /// The vertices of pads that tools grasp. A pad moves the mesh: it and the points beside it have the compliance of
  /// the mesh only, so that elements are not inverted by the part of the displacement that the mesh does not show.
  /// Returns whether these are others than before.
  bool pin(std::span<const int> vertices) noexcept;
  bool depends_on_pad(const ContactSample& sample) const noexcept {
    return subfacet_ && pinned_count_ > 0 && is_pinned(sample);
  }
  /// Sets the level from which on a tool has all points.
  void set_level(std::size_t tool, int level) noexcept;
  std::span<Candidate> items() noexcept { return list_.points.items(); }
  bool has_any(int tool) const noexcept;
  void forget() noexcept { valid_ = false; }
  /// Back to the state after construction.
  void reset() noexcept;
  /// Whether the list has all points that a tool may reach.
  bool is_complete(std::size_t t, const ContactTool& tool) const noexcept;
  /// Points of a tool in the list, and room in the list.
  int count(int tool) const noexcept;
  int room() const noexcept { return maximum() - list_.points.count(); }
  /// `update` once more in a tick, with other levels: the list is built again.
  Status update_again(const TissueView& tissue, std::span<const ContactTool> tools,
                      SurfaceDisplacement& displacement) noexcept;
  /// Whether the last update rebuilt the list: candidates have moved in memory.
  bool is_new() const noexcept { return is_new_; }
  /// Whether a force of the previous list is missing in the last list because its tool was lifted. The surface then
  /// springs back by an unknown amount, and the next update rebuilds the list.
  bool has_lost_forces() const noexcept { return lost_forces_; }

  /// Continues on the surface of the same body after a cut: vertices keep their numbers, triangles and points need not.
  /// Points on triangles that no longer exist lose their force. `fresh` was constructed for that surface and receives
  /// the old samples. No allocation.
  void move_to(Candidates& fresh, const ContactSurface& surface) noexcept;
  /// Moves a candidate to the sample nearest to its sample of another surface; false when no sample is near.
  bool move(Candidate& c, const ContactSamples& before, const ContactSurface& surface) const noexcept;

  /// Applies changes since the last tick: tools moved elsewhere, lifted or set down, a moved resting surface.
  /// Returns whether the resting surface has moved.
  bool begin_tick(const ContactSurface& surface, std::span<const ContactTool> tools) noexcept;
  /// Updates the position of the sphere of a tool.
  void move_sphere(std::size_t t, const ContactTool& tool) noexcept;
  /// Adds a displacement of the surface; `distance` is an upper bound for every point of it [m].
  void move_surface(double distance) noexcept { surface_travel_ += distance; }

  /// Once per tick: builds a part of the next list when the present one will not stay valid for long.
  void prepare(const TissueView& tissue, std::span<const ContactTool> tools,
               SurfaceDisplacement& displacement) noexcept;
  /// Takes the next list, or builds one, unless the list stays valid for another linearisation. degraded_model when
  /// there is no room for all points that a sphere may reach.
  Status update(const TissueView& tissue, std::span<const ContactTool> tools,
                SurfaceDisplacement& displacement) noexcept;

  /// Whether a candidate was not evaluated yet, or sphere or surface may have moved since.
  bool is_stale(const Candidate& c) const noexcept {
    return !c.evaluated || travel(static_cast<std::size_t>(c.tool)) != c.seen;
  }
  /// Lower bound of the present gap of a candidate.
  double least_gap(const Candidate& c) const noexcept {
    return c.gap - (travel(static_cast<std::size_t>(c.tool)) - c.seen);
  }

  /// What is read of a candidate in every round: many of these stay in the cache.
  struct Near {
    int number, tool;
    double until;  ///< its gap is not negative before sphere and surface have travelled so far [m]
  };
  /// All candidates whose gap may be at most that of their tool in `reach`, and some more, by increasing number.
  /// Collected again only when spheres and surface have moved by a part of the radius: most candidates are farther, and
  /// visiting all of them in every round would cost as much as a small contact.
  std::span<Near> within(const std::array<double, maximum_tools>& reach, std::span<const ContactTool> tools) noexcept;
  /// Lower bound of the present gap, from the gap known at the last `note_gap` [m].
  double least_gap(const Near& n) const noexcept { return n.until - travel(static_cast<std::size_t>(n.tool)); }
  /// Takes over the gap that the candidate has by now.
  void note_gap(Near& n) const noexcept { n.until = until(list_.points[n.number]); }

  /// Raises the lower bound of a candidate's gap to that by the displacement of its vertices, where `position` costs
  /// more than that, and returns the bound.
  double raise_least_gap(const TissueView& tissue, const ContactTool& tool, SurfaceDisplacement& displacement,
                         Candidate& c) const noexcept;
  /// Evaluates a candidate at the present deformation and proxy.
  void evaluate(const TissueView& tissue, const ContactTool& tool, SurfaceDisplacement& displacement,
                Candidate& c) noexcept;
  /// Deformed position of a candidate's point [m], computed once per generation of the displacement.
  const Vector3& position(const TissueView& tissue, SurfaceDisplacement& displacement, Candidate& c) const noexcept;
  /// Upper bound of how far its point has moved along its normal since it was placed; infinite where `position` costs
  /// as little [m].
  double longest_move(const TissueView& tissue, SurfaceDisplacement& displacement, const Candidate& c) const noexcept;
  /// Sets the position of a candidate's point and updates its gap and normal.
  inline void place(Candidate& c, const Vector3& point, const ContactTool& tool) const noexcept;

  /// Whether the sphere is on the outer side of a facet that contains the point, at rest or deformed.
  bool faces_sphere(const TissueView& tissue, SurfaceDisplacement& displacement, const Candidate& c) const noexcept;

  /// Upper bound of the displacement of the surface near the tools, as far as it is known [m].
  double reach(const TissueView& tissue, SurfaceDisplacement& displacement) const noexcept;
  /// The same for distances from where the surface is expected. A tool that does not press may be at a part that
  /// others move farther than the points that they press: the path of these counts, too.
  double reach_from_expected(const TissueView& tissue, std::span<const ContactTool> tools,
                             SurfaceDisplacement& displacement) const noexcept;

  /// Checks the next few vertices of the scan.
  void look_round(const TissueView& tissue, std::span<const ContactTool> tools,
                  SurfaceDisplacement& displacement) noexcept;

  /// Position of a sample on the resting surface [m].
  inline static Vector3 rest(const ContactSurface& surface, const ContactSample& sample) noexcept;

 private:
  static constexpr int per_tick = 2;
  static constexpr std::size_t least_room = 1024;  // points: a large tool on fine facets has many more near than rows
  static constexpr int not_begun = -1;             // Descent::top, before the search for a tool
  static constexpr double margin = 0.25;           // radii
  static constexpr double begin_used = 0.6, end_used = 0.8;  // parts of the margin while the next list is built

  inline static const Vector3& expected_position(const ContactSurface& surface, int vertex) noexcept;
  inline static Vector3 expected_position(const ContactSurface& surface, const ContactSample& sample) noexcept;
  inline static double needed(const ContactTool& tool) noexcept;
  bool is_pinned(const ContactSample& sample) const noexcept;
  int triangle_of(const ContactSurface& surface, int sample) const noexcept;
  double travel(std::size_t tool) const noexcept { return travel_[tool] + surface_travel_; }
  static double until(const Candidate& c) noexcept { return c.gap + c.seen; }

  struct List {
    explicit List(std::size_t maximum) : points(maximum), farthest(maximum) {}
    CandidateList points;
    FarthestCandidate farthest;                          // of the others, once the list is full
    int room = 0, kept = 0;                              // kept: points that press, before the others
    std::array<double, maximum_tools> range{}, built{};  // range: gaps up to which it was complete at travel `built`
    double reach = 0.0;                                  // of the surface when the search began
    double surface_built = 0.0;                          // travel of the surface then
    std::array<int, maximum_tools> level{};
  };
  /// A search for the points of a list, tool by tool.
  struct Search {
    Bvh::Descent descent;
    std::size_t tool = 0;
    int leaves = 0;      // visited
    double reach = 0.0;  // of the surface at present
    bool runs = false, ends = false;
    bool in_parts = false;  // one part per tick, while the present list is valid
  };
  double used(const List& list, std::span<const ContactTool> tools) const noexcept;
  bool has_levels(const List& list) const noexcept;
  void begin(Search& search, List& list, int room) const noexcept;
  bool advance(const TissueView& tissue, std::span<const ContactTool> tools, Search& search, List& list,
               SurfaceDisplacement& displacement) noexcept;
  void build(const TissueView& tissue, std::span<const ContactTool> tools, SurfaceDisplacement& displacement) noexcept;
  void take_next() noexcept;
  void store_loaded() noexcept;
  void keep_loaded(const TissueView& tissue, std::span<const ContactTool> tools,
                   SurfaceDisplacement& displacement) noexcept;
  inline static Vector3 place_by_vertices(const TissueView& tissue, SurfaceDisplacement& displacement,
                                          const ContactSample& sample) noexcept;
  struct Bound {
    Vector3 position;    ///< without the half-space [m]
    double bulge = 0.0;  ///< how far outward of it the point may be [m]
  };
  Bound bound(const TissueView& tissue, SurfaceDisplacement& displacement, int sample) const noexcept;
  inline double known_gap(int tool, int sample) const noexcept;
  void examine(const TissueView& tissue, const ContactTool& tool, int triangle, const Search& search, List& list,
               SurfaceDisplacement& displacement) noexcept;
  void consider(const TissueView& tissue, const ContactTool& tool, Candidate& c, const Search& search, List& list,
                SurfaceDisplacement& displacement) noexcept;

  ContactSamples samples_;
  std::shared_ptr<const SubfacetCompliance> subfacet_;
  List list_, next_list_;
  Search search_;                          // for the next list, or for one that is built at once
  int leaves_ = 0;                         // visited for the list
  std::array<int, most_pinned> pinned_{};  // vertices of pads
  int pinned_count_ = 0;
  std::vector<Candidate> loaded_;  // points of the list before that press
  int loaded_count_ = 0;
  bool valid_ = false, is_new_ = false, lost_forces_ = false;
  std::uint64_t revision_ = 0;
  std::vector<Near> near_;
  int near_count_ = -1;  // negative: not collected
  std::array<double, maximum_tools> near_range_{}, near_travel_{};
  std::array<Vector3, maximum_tools> proxy_, outward_;
  std::array<double, maximum_tools> entered_{};
  std::array<Matrix3, maximum_tools> rotation_;
  std::array<bool, maximum_tools> was_active_{};
  std::array<int, maximum_tools> level_{};
  std::array<double, maximum_tools> travel_{};
  double surface_travel_ = 0.0;
  /// Largest distances of vertices that the scan found outside the reach.
  struct Far {
    double rest = 0.0, expected = 0.0;
  };
  Far far_, far_last_round_;
  int next_ = 0;  // next vertex of the scan
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/candidates.ipp>
#include <palpate/contact/detail/candidates_search.ipp>
#endif
