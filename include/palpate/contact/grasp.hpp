// A point of the surface grasped by a tool.
#pragma once

#include <palpate/contact/detail/candidates.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A point of the surface grasped by a tool, as three bilateral rows. The point has no unilateral row in addition.
struct Grasp {
  static constexpr double reach = 0.1;  ///< largest gap, in radii, of a point that can be grasped

  bool requested = false;  ///< since the tool began to grasp
  int sample = -1;         ///< -1: no point was near enough
  std::array<Candidate, 3> rows{};

  /// Grasps this point at its present place on the tool.
  void take(const Candidate& point, const ContactTool& tool) noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/grasp.ipp>
#endif
