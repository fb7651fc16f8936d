// How many contact points every tool has.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/contact_samples.hpp>

#include <algorithm>
#include <array>
#include <numbers>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The level of the contact samples for every tool, so that a press has about the same number of points on any mesh and
/// at any depth. A tool has a whole level as long as the points in the area that presses are 0.7 to 1.6 times the
/// wanted number: a tool that slides, or presses little deeper, keeps its points, and its forces have an energy. From
/// one level to the next it goes in small steps: points fade in and out (ContactSamples::area), so that the force has
/// no jump. A tool with more points than its share of the rows gets a higher level at once. What one tool does not need
/// of the rows is for the others. No allocation.
class PointLevels {
 public:
  static constexpr double finest_spacing = 0.125;  ///< of the lattice on long facets, in radii
  static constexpr double coarsest_spacing = 0.5;  ///< in ContactTool::point_scale
  static constexpr double crowded_spacing = std::numbers::sqrt2 * coarsest_spacing;  ///< without rows for that
  static constexpr double coarsest_of_mesh = 0.8;  ///< without areas; a sphere does not fall through points within two

  /// Back to the state after construction.
  void reset() noexcept { *this = {}; }
  /// The tools continue on other points, whose finest level may differ a little: levels stay, what is known of rows and
  /// room for others is forgotten.
  void change_points() noexcept;
  struct Limits {
    int capacity = 0;       ///< rows of all tools
    int wanted = 0;         ///< points of a press
    bool has_areas = true;  ///< forces depend on the areas of the points; else a tool has the finest level that fits
  };
  /// What the spacing of a tool's points is relative to [m]; 0 of a tool that is not in use.
  struct Size {
    double radius = 0.0, scale = 0.0;  ///< scale: ContactTool::point_scale
  };
  /// Divides the rows among the tools near the surface and limits their levels.
  void begin_tick(const ContactSamples& samples, const std::array<Size, maximum_tools>& sizes,
                  const std::array<bool, maximum_tools>& is_near, const Limits& limits) noexcept;
  int share(int tool) const noexcept { return share_[at(tool)]; }
  bool has_areas() const noexcept { return limits_.has_areas; }
  double level(int tool) const noexcept { return level_[at(tool)]; }
  /// Whether a tool had fewer points in the last tick than one that begins to press.
  bool had_fewer(int tool) const noexcept { return used_[at(tool)] > touch_[at(tool)]; }
  /// Whether a tool has no level above its own.
  bool is_coarsest(int tool) const noexcept { return !(level_[at(tool)] < crowded_[at(tool)]); }
  /// The last level that has all points of a tool.
  int first(int tool) const noexcept { return static_cast<int>(level_[at(tool)]); }
  /// The last level that has all points that a tool has to know: without areas, points of the next finer level show how
  /// far it sinks in between its own.
  int known(int tool) const noexcept { return limits_.has_areas ? first(tool) : std::max(0, first(tool) - 1); }
  /// The level of a tool that begins to press with this area [m^2], of which parts may not press in the end.
  void start(const ContactSamples& samples, int tool, double area) noexcept;

  /// Where a list of candidates has not all points near the tools, the tool with the most of them gets a higher level,
  /// and keeps it until twice as many have room. True where it has it at once: a tool that does not press yet.
  bool note_full_list(int tool) noexcept;
  /// Points of a tool in a list, and room that is left.
  void note_room(int tool, int points, int room) noexcept;
  /// Forgets the points noted before: those of the last round of a tick count.
  void begin_round() noexcept;
  /// A point that has no row because of the level, where there are no areas: the tool sinks in between the others [m];
  /// 0 where the force does not notice.
  void note_skipped(int tool, double penetration) noexcept;
  /// A point for which there is no room, and its penetration [m].
  void note_left_out(int tool, double penetration) noexcept;
  /// Sets the levels for the next tick. Per tool: rows that press, how many points of equal area its print has
  /// (ContactRows::points_of_print), rows of grasped points, and vertices in its print that should not be fewer than
  /// points, 0 where that does not matter.
  void end_tick(const std::array<int, maximum_tools>& used, const std::array<double, maximum_tools>& points,
                const std::array<int, maximum_tools>& grasped,
                const std::array<double, maximum_tools>& vertices = {}) noexcept;
  /// Penetration of the deepest point without a row [m].
  double deepest() const noexcept { return deepest_; }

 private:
  static constexpr int headroom = 16;  // rows above those of the last tick: as many, or twice as many as it had
  // From these rows on a tool gets a higher level: a part of its share, and as many per wanted point, so that it hardly
  // depends on what other tools need.
  static constexpr double most_rows = 0.9, rows_per_point = 2.4;
  // Levels per tick: usually, and where its rows, from this part of its share on, or room in the list may not suffice.
  static constexpr double longest_step = 0.1, full_step = 0.5, many_rows = 0.65;
  static constexpr std::size_t at(int tool) noexcept { return static_cast<std::size_t>(tool); }
  void divide() noexcept;
  double wanted(std::size_t tool) const noexcept;
  double step(std::size_t tool, int used, double growth, double points) noexcept;
  double least_with_rows(std::size_t tool, bool is_many, double rows) noexcept;
  double touch_level(std::size_t tool) const noexcept { return std::max(touch_[tool], with_room_[tool]); }
  double next_goal(std::size_t tool, double size) noexcept;

  std::array<int, maximum_tools> share_{}, had_{}, needed_{}, left_out_{}, skipped_{};
  std::array<double, maximum_tools> radius_{}, level_{}, goal_{}, least_{}, touch_{}, most_{}, crowded_{};
  std::array<double, maximum_tools> with_room_{};  // the least level with room in the list of candidates
  std::array<double, maximum_tools> vertices_{};   // in the print of the last tick, or 0
  std::array<double, maximum_tools> used_{};       // the levels of the last tick
  /// The last time that the points of a tool did not fit.
  struct Overflow {
    double level = 0.0;  ///< at which they fit
    double rows = -1.0;  ///< that pressed there, were it level 0; negative: not known yet
    int share = 0;       ///< rows; 0: never
  };
  std::array<Overflow, maximum_tools> overflow_{};
  /// The last way of a tool from one level to another.
  struct Way {
    double sense = 0.0;    ///< of the change of the level
    bool travels = false;  ///< whether the tool is between levels
    double size = 0.0;     ///< of the print when that began or ended, were the level 0
  };
  std::array<Way, maximum_tools> way_{};
  double deepest_ = 0.0;
  Limits limits_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/point_levels.ipp>
#endif
