// A point of the surface that a tool holds.
#pragma once

#include <palpate/contact/detail/candidates.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A point of the surface held by a tool, as three rows that pull as well as push. No row of its own is left to it.
struct Grasp {
  static constexpr double reach = 0.1;  ///< gap, in radii, of a point that can be held

  bool asked = false;
  int sample = -1;  ///< -1: nothing was there to be held
  std::array<Candidate, 3> rows{};

  /// Holds this point where it is on the tool now.
  void hold(const Candidate& point, const ContactTool& tool) noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/grasp.ipp>
#endif
