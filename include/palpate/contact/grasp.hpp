// What a tool grasps of the surface.
#pragma once

#include <palpate/contact/detail/candidates.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A point of the surface grasped by a tool, or a pad: a group of vertices. Every point has three bilateral rows and
/// keeps its place on the tool. Points that the group moves have no unilateral row in addition.
class Grasp {
 public:
  static constexpr double reach = 0.1;  ///< largest gap, in radii, of a point that can be grasped
  static constexpr int most_points = detail::Candidates::most_pinned / maximum_tools;  ///< of a pad, the nearest ones
  static constexpr int most_visited = 64;  ///< vertices in the search for them

  bool requested = false;  ///< since the tool began to grasp

  bool holds_any() const noexcept { return count_ > 0; }
  /// The vertices of a pad; none of a point within a triangle.
  std::span<const int> pad() const noexcept {
    return {vertices_.data(), count_ > 0 && vertices_[0] >= 0 ? static_cast<std::size_t>(count_) : 0};
  }
  /// Whether a pad is larger than its radius: the triangle in its middle reaches beyond it.
  bool is_coarse() const noexcept { return count_ > 0 && is_coarse_; }
  std::span<detail::Candidate> rows() noexcept { return {rows_.data(), 3 * static_cast<std::size_t>(count_)}; }
  /// Whether a row of its own would be stiff: of a point that is grasped, lies within the disc of a grasped point, or
  /// moves more with the vertices of a pad than with others.
  bool holds(const ContactSurface& surface, const detail::Candidates& candidates,
             const detail::Candidate& c) const noexcept;

  /// Grasps this point at its present place on the tool.
  void grasp_point(const detail::Candidate& point, const ContactTool& tool) noexcept;
  /// Grasps the corners of the point's triangle and the vertices within `radius` [m] of the point along the surface, at
  /// most `most`, the nearest ones. They have no place on the tool before `place_pad`. No allocation; bounded work.
  void grasp_pad(const ContactSurface& surface, const detail::Candidates& candidates, const detail::Candidate& point,
                 const ContactTool& tool, double radius, int most) noexcept;
  /// Gives the vertices of the pad their present places on the tool.
  void place_pad(const TissueView& tissue, detail::Candidates& candidates, detail::SurfaceDisplacement& displacement,
                 const ContactTool& tool) noexcept;
  void release() noexcept;
  /// Continues on another surface; points whose triangles no longer exist are released.
  void move_to(const detail::Candidates& candidates, const detail::ContactSamples& before,
               const ContactSurface& surface) noexcept;

 private:
  std::array<detail::Candidate, 3 * most_points> rows_{};
  std::array<int, most_points> vertices_{};  // of a pad; -1: a point within a triangle
  int count_ = 0;                            // points
  bool is_coarse_ = false;                   // of a pad
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/grasp.ipp>
#endif
