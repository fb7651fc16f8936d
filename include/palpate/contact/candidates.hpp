// The contact points near the balls, remembered from tick to tick.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_samples.hpp>
#include <palpate/contact/surface_displacement.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What a row was linearised with and what came of it, of the last linearisation and the one before.
struct NormalHistory {
  Vector3 used = Vector3::Zero(), used_before = Vector3::Zero(), made_before = Vector3::Zero();
  int known = 0;  ///< how many linearisations in a row, at most 2
};

/// A contact point near the ball of one tool, as it was when last looked at.
struct Candidate {
  int sample = 0;
  int triangle = 0;
  int tool = 0;
  int row = -1;                      ///< of the contact problem, -1 when it has none
  int slot = -1;                     ///< where its compliance was remembered last
  bool facing = true;                ///< the ball is on the outer side
  double gap = 0.0;                  ///< [m]
  double seen = 0.0;                 ///< travel of ball and surface until then [m]
  double force = 0.0;                ///< of the last solution [N]
  Vector3 point = Vector3::Zero();   ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();  ///< unit, from the point to the ball's centre
  double along = 0.0;                ///< where on a capsule's axis that centre lies [m]
  NormalHistory history;

  Vector3 friction = Vector3::Zero();  ///< of the last solution, on the tool [N]
  Vector3 anchor = Vector3::Zero();    ///< where the point clung to the tool after the last tick, tool's own frame [m]
  std::uint64_t clung = 0;             ///< the tick after which it did
  bool grasped = false;                ///< no point near a ball, but one that is held

  /// Forgets what it carried.
  void lift() noexcept {
    force = 0.0;
    clung = 0;
    history.known = 0;
  }
};

/// All contact points that a ball can reach within a tick, and some more, so that the list holds for a while: the way
/// of ball and surface since then is summed up and the list made anew when the margin is used up (as neighbour lists in
/// molecular dynamics, Verlet 1967). A point is evaluated again only when that way could have closed its gap. The
/// search on the resting surface reaches as far as the surface has moved (SurfaceDisplacement::reach); a round over all
/// vertices, a few per tick, finds what moved farther. No allocation; work bounded by `maximum` and, when the
/// list is made anew, by the samples of all triangles in reach: each is looked at. `Capacity` is that of the contact problem.
template <int Capacity>
class Candidates {
 public:
  static constexpr int maximum = 4 * Capacity;
  using Displacement = SurfaceDisplacement<3 * Capacity>;

  /// Places the samples `spacing` [m] apart. Allocates; for set-up.
  Candidates(const ContactSurface& surface, double spacing) : samples_(surface, spacing) {
    proxy_.fill(Vector3::Zero());
    axis_.fill(Vector3::Zero());
  }

  const ContactSamples& samples() const noexcept { return samples_; }
  std::span<Candidate> items() noexcept { return {items_.data(), static_cast<std::size_t>(count_)}; }
  bool has_any(int tool) const noexcept {
    return std::any_of(items_.begin(), items_.begin() + count_, [tool](const Candidate& c) { return c.tool == tool; });
  }
  void forget() noexcept { valid_ = false; }
  /// Whether the last update made another list: candidates are elsewhere in memory.
  bool is_new() const noexcept { return is_new_; }
  /// Whether the last list has no place for a force of the one before: its tool was lifted. The surface then springs
  /// back by an unknown amount, and the next update makes another list.
  bool has_lost_forces() const noexcept { return lost_forces_; }

  /// Goes on on the same body's surface after a cut: vertices have the same numbers, triangles and points need not. What
  /// lay on triangles that are gone does not press any more. `fresh` was made for that surface and gets the old samples.
  /// No allocation.
  void move_to(Candidates& fresh, const ContactSurface& surface) noexcept {
    std::swap(samples_, fresh.samples_);
    const ContactSamples& before = fresh.samples_;
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      Candidate c = items_[static_cast<std::size_t>(i)];
      if (!(c.force > 0.0) || !move(c, before, surface)) continue;
      const auto end = items_.begin() + kept;
      const auto same = std::find_if(items_.begin(), end,
                                     [&](const Candidate& d) { return d.sample == c.sample && d.tool == c.tool; });
      if (same == end) {
        items_[static_cast<std::size_t>(kept++)] = c;
      } else {
        same->force += c.force;
        same->friction += c.friction;
      }
    }
    count_ = kept;
    next_ = 0;
    valid_ = false;
    revision_ = surface.revision();
  }
  /// Puts a candidate on the sample that lies where its own of another surface lay; false when there is none.
  bool move(Candidate& c, const ContactSamples& before, const ContactSurface& surface) const noexcept {
    c.sample = samples_.nearest(surface, before[c.sample]);
    if (c.sample < 0) return false;
    c.triangle = triangle_of(surface, c.sample);
    c.row = c.slot = -1;
    c.history = {};
    return true;
  }

  /// Takes in what happened since the last tick: tools put elsewhere, lifted or set down, a moved resting surface.
  void begin_tick(const ContactSurface& surface, std::span<const ContactTool> tools) noexcept {
    if (revision_ != surface.revision()) forget();
    revision_ = surface.revision();
    for (std::size_t t = 0; t < tools.size(); ++t) {
      if (tools[t].active != was_active_[t]) forget();
      was_active_[t] = tools[t].active;
      if (tools[t].active) move_ball(t, tools[t]);
    }
  }
  /// The ball of a tool is here now.
  void move_ball(std::size_t t, const ContactTool& tool) noexcept {
    travel_[t] += (tool.proxy - proxy_[t]).norm();
    proxy_[t] = tool.proxy;
    if (tool.half_length == 0.0) return;
    const Vector3 axis = tool.axis();
    travel_[t] += tool.half_length * (axis - axis_[t]).norm();
    axis_[t] = axis;
  }
  /// No point of the surface has moved farther than this.
  void move_surface(double distance) noexcept { surface_travel_ += distance; }

  /// Makes the list anew unless it still holds for another linearisation. degraded_model when there is no room for all
  /// that a ball may reach.
  template <TissueModel Tissue>
  Status update(const Tissue& tissue, std::span<const ContactTool> tools, Displacement& displacement) noexcept {
    Status status;
    is_new_ = false;
    bool holds = valid_;
    for (std::size_t t = 0; t < tools.size() && holds; ++t)
      holds = !tools[t].active || needed(tools[t]) <= range_[t] - (travel(t) - built_[t]);
    if (!holds) build(tissue, tools, displacement);
    for (std::size_t t = 0; t < tools.size(); ++t)
      if (tools[t].active && range_[t] < needed(tools[t])) status.set(StatusFlag::degraded_model);
    return status;
  }

  /// Whether ball or surface may have moved since a candidate was looked at.
  bool is_stale(const Candidate& c) const noexcept { return travel(static_cast<std::size_t>(c.tool)) != c.seen; }
  /// At least the gap of a candidate now.
  double least_gap(const Candidate& c) const noexcept {
    return c.gap - (travel(static_cast<std::size_t>(c.tool)) - c.seen);
  }

  /// Evaluates a candidate at the present deformation and proxy.
  template <TissueModel Tissue>
  void evaluate(const Tissue& tissue, const ContactTool& tool, Displacement& displacement, Candidate& c) noexcept {
    const ContactSample& sample = samples_[c.sample];
    Vector3 point = Vector3::Zero();
    for (std::size_t a = 0; a < 3; ++a)
      if (sample.weights[a] > 0.0) point += sample.weights[a] * displacement.position(tissue, sample.vertices[a]);
    place(c, point, tool);
    c.facing = faces_ball(tissue, displacement, c);
  }
  /// Sets where a candidate's point is.
  void place(Candidate& c, const Vector3& point, const ContactTool& tool) const noexcept {
    c.point = point;
    c.along = tool.along(point);
    const Vector3 offset =
        c.along != 0.0 ? Vector3(tool.proxy + c.along * tool.axis() - point) : Vector3(tool.proxy - point);
    const double distance = offset.norm();
    c.normal = distance > 0.0 ? Vector3(offset / distance) : Vector3::UnitZ();
    c.gap = distance - tool.radius;
    c.seen = travel(static_cast<std::size_t>(c.tool));
  }

  /// Looks at the next few vertices of the round.
  template <TissueModel Tissue>
  void look_round(const Tissue& tissue, std::span<const ContactTool> tools, Displacement& displacement) noexcept {
    const ContactSurface& surface = tissue.contact_surface();
    for (int k = 0; k < per_tick && k < surface.vertex_count(); ++k) {
      if (++next_ >= surface.vertex_count()) {
        next_ = 0;
        far_last_round_ = far_;
        far_ = 0.0;
      }
      const double moved = displacement.at(tissue, next_).norm();
      if (moved <= reach_) continue;
      const Vector3 x = displacement.position(tissue, next_);
      for (std::size_t t = 0; t < tools.size(); ++t)
        if (tools[t].active && (x - tools[t].proxy).norm() < tools[t].radius + tools[t].half_length + range_[t]) {
          far_ = std::max(far_, 1.1 * moved);
          forget();
        }
    }
  }

  /// Resting place of a sample [m].
  Vector3 rest(const ContactSurface& surface, int s) const noexcept {
    const ContactSample& sample = samples_[s];
    return sample.weights[0] * surface.position(sample.vertices[0]) +
           sample.weights[1] * surface.position(sample.vertices[1]) +
           sample.weights[2] * surface.position(sample.vertices[2]);
  }

 private:
  static constexpr int per_tick = 2;

  /// Points this near may be reached while the linearisation settles; leaving one out lets the ball fall through it.
  static double needed(const ContactTool& tool) noexcept { return tool.longest_step() + 0.5 * tool.way(); }
  int triangle_of(const ContactSurface& surface, int sample) const noexcept {
    for (const int t : surface.triangles_at(samples_[sample].vertices[0]))
      if (samples_.first_of(t) <= sample && sample < samples_.first_of(t + 1)) return t;
    return 0;
  }
  double travel(std::size_t tool) const noexcept { return travel_[tool] + surface_travel_; }

  template <TissueModel Tissue>
  void build(const Tissue& tissue, std::span<const ContactTool> tools, Displacement& displacement) noexcept {
    loaded_count_ = 0;
    for (const Candidate& c : items())
      if (c.force > 0.0 && loaded_count_ < Capacity) loaded_[static_cast<std::size_t>(loaded_count_++)] = c;
    keep_loaded(tissue, tools, displacement);
    is_new_ = true;
    reach_ = std::max({displacement.reach(tissue), far_, far_last_round_});
    const ContactSurface& surface = tissue.contact_surface();
    for (std::size_t t = 0; t < tools.size(); ++t) {
      const ContactTool& tool = tools[t];
      if (!tool.active) continue;
      range_[t] = needed(tool) + 0.25 * tool.radius;
      built_[t] = travel(t);
      const double far = tool.radius + range_[t] + reach_;
      const Vector3 axis = tool.axis();
      surface.bvh().visit_near(tool.proxy, far + tool.half_length, [&](int triangle) {
        for (int s = samples_.first_of(triangle); s < samples_.first_of(triangle + 1); ++s) {
          const Vector3 x = rest(surface, s);
          if ((x - tool.proxy - tool.along(x) * axis).squaredNorm() <= far * far)
            consider(tissue, tool, static_cast<int>(t), triangle, s, displacement);
        }
      });
    }
    valid_ = !lost_forces_;
  }

  /// Begins a new list with what presses, and goes on pressing however far the ball is still from where it goes.
  template <TissueModel Tissue>
  void keep_loaded(const Tissue& tissue, std::span<const ContactTool> tools, Displacement& displacement) noexcept {
    lost_forces_ = false;
    count_ = 0;
    for (int i = 0; i < loaded_count_; ++i) {
      const Candidate& old = loaded_[static_cast<std::size_t>(i)];
      const ContactTool& tool = tools[static_cast<std::size_t>(old.tool)];
      lost_forces_ = lost_forces_ || !tool.active;
      if (!tool.active) continue;
      Candidate& c = items_[static_cast<std::size_t>(count_++)] = old;
      c.row = -1;
      c.history.known = 0;
      evaluate(tissue, tool, displacement, c);
    }
    loaded_count_ = count_;
  }
  bool is_loaded(int tool, int sample) const noexcept {
    return std::any_of(items_.begin(), items_.begin() + loaded_count_,
                       [=](const Candidate& c) { return c.sample == sample && c.tool == tool; });
  }

  /// Takes a sample into the list if it is near; when the list is full, it holds as far as the nearest one left out.
  /// What presses stays.
  template <TissueModel Tissue>
  void consider(const Tissue& tissue, const ContactTool& tool, int t, int triangle, int sample,
                Displacement& displacement) noexcept {
    Candidate c;
    c.sample = sample;
    c.triangle = triangle;
    c.tool = t;
    evaluate(tissue, tool, displacement, c);
    double& range = range_[static_cast<std::size_t>(t)];
    if (!(c.gap <= range) || is_loaded(t, sample)) return;
    if (count_ < maximum) {
      items_[static_cast<std::size_t>(count_++)] = c;
      return;
    }
    Candidate& farthest = *std::max_element(items_.begin() + loaded_count_, items_.end(),
                                            [](const Candidate& a, const Candidate& b) { return a.gap < b.gap; });
    double& lost = range_[static_cast<std::size_t>(farthest.gap > c.gap ? farthest.tool : t)];
    lost = std::min(lost, std::max(c.gap, farthest.gap));
    if (farthest.gap > c.gap) farthest = c;
  }

  /// Whether the ball lies on the outer side of a triangle that the point belongs to, as it rests or as it is deformed:
  /// in a steep dent only the latter holds. What the ball sees through a thin part from behind fails both.
  template <TissueModel Tissue>
  bool faces_ball(const Tissue& tissue, Displacement& displacement, const Candidate& c) const noexcept {
    const ContactSurface& surface = tissue.contact_surface();
    if (c.normal.dot(surface.normal(c.triangle)) > 0.0) return true;
    const ContactSample& sample = samples_[c.sample];
    for (int t : surface.triangles_at(sample.vertices[0])) {
      bool contains = true;
      for (std::size_t a = 1; a < 3; ++a)
        contains =
            contains && (sample.weights[a] == 0.0 || std::ranges::count(surface.triangle(t), sample.vertices[a]) > 0);
      if (contains && c.normal.dot(surface.normal(t)) > 0.0) return true;
    }
    const Triangle& v = surface.triangle(c.triangle);
    const Vector3 x0 = displacement.position(tissue, v[0]);
    const Vector3 x1 = displacement.position(tissue, v[1]);
    const Vector3 x2 = displacement.position(tissue, v[2]);
    return c.normal.dot((x1 - x0).cross(x2 - x0)) > 0.0;
  }

  ContactSamples samples_;
  std::array<Candidate, static_cast<std::size_t>(maximum)> items_{};
  std::array<Candidate, static_cast<std::size_t>(Capacity)> loaded_{};  // of the list before
  int count_ = 0, loaded_count_ = 0;
  bool valid_ = false, is_new_ = false, lost_forces_ = false;
  std::uint64_t revision_ = 0;
  std::array<Vector3, maximum_tools> proxy_{}, axis_{};
  std::array<bool, maximum_tools> was_active_{};
  std::array<double, maximum_tools> range_{}, built_{}, travel_{};  // range: gaps up to which the list was complete
  double surface_travel_ = 0.0;
  double reach_ = 0.0, far_ = 0.0, far_last_round_ = 0.0;
  int next_ = 0;  // vertex of the round
};

}}  // namespace palpate
