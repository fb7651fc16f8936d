// Which points get the rows of the contact problem when more press than there is room for.
#pragma once

#include <palpate/contact/contact.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Divides the rows among the tools, by what they needed in the last tick: what one tool does not need is for the
/// others. Of a tool that presses more points than its share, fewer per area get rows (ContactSamples::density): the
/// rows cover the whole contact with larger spacing, at most 0.8 radii, and the tool sinks in slightly between them.
/// The density changes slowly where it can, so that few points change in a tick. No allocation.
class RowShares {
 public:
  /// Back to the state after construction.
  void reset() noexcept;
  /// Divides the rows among the tools. `radius`: of the tools near the surface; 0 for the others. `densest`: of all
  /// points.
  void begin_tick(const std::array<double, maximum_tools>& radius, int capacity, double densest) noexcept;
  int share(int tool) const noexcept { return share_[at(tool)]; }
  /// Whether a point of this density may have a row.
  bool keeps(int tool, double density) const noexcept { return density < density_[at(tool)]; }
  /// Forgets the points noted before: those of the last round of a tick count.
  void begin_round() noexcept;
  /// A point that is left out because of its density, and its penetration at the solution [m].
  void note_skipped(int tool, double penetration) noexcept;
  /// A point for which there is no room, and its penetration.
  void note_left_out(int tool, double penetration) noexcept;
  /// Sets the densities for the next tick. `used`: rows with force, per tool.
  void end_tick(const std::array<int, maximum_tools>& used) noexcept;
  /// Penetration of the deepest point without a row [m].
  double deepest() const noexcept { return deepest_; }

 private:
  static constexpr int headroom = 16;  // rows above those of the last tick for a tool that needs less than its share
  static constexpr std::size_t at(int tool) noexcept { return static_cast<std::size_t>(tool); }
  void divide() noexcept;

  std::array<int, maximum_tools> share_{}, needed_{}, skipped_{}, left_out_{};
  std::array<double, maximum_tools> radius_{}, density_{};
  double densest_ = 0.0, deepest_ = 0.0;
  int capacity_ = 0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/row_shares.ipp>
#endif
