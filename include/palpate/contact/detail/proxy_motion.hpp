// Motion of the proxies within a tick.
#pragma once

#include <palpate/contact/contact.hpp>

#include <array>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Moves the proxies of all tools: first with their devices, then from linearisation to linearisation to the positions
/// of the solution. Reports how far the next step goes and how much the forces changed in the last. No allocation.
class ProxyMotion {
 public:
  using Tools = std::span<ContactTool>;
  /// Displacement of a proxy to its goal under the present force.
  struct Ahead {
    Vector3 path = Vector3::Zero(),
            axis = Vector3::Zero();  ///< of the proxy [m]; change of a capsule's unit axis
    double farthest = 0.0;           ///< upper bound of the displacement of any of its points [m]
  };

  /// Moves the proxies with their devices, perpendicular to the contact force: this makes the first linearisation
  /// nearly exact for a sphere that slides.
  static void slide(Tools tools) noexcept;
  /// Stores the forces at the start of a linearisation.
  void begin(Tools tools) noexcept;
  /// N], as TissueModel has it./N], as TissueModel has it.
  void look_ahead(Tools tools, double floor) noexcept;
  const Ahead& ahead(std::size_t tool) const noexcept { return ahead_[tool]; }
  /// Moves the proxies to the positions of the solution, as far as one linearisation may go; true when all arrive.
  bool follow(Tools tools, double floor) noexcept;
  /// Relative change of the tools' forces and torques since `begin`.
  double relative_change(Tools tools) const noexcept;

 private:
  static void rotate(ContactTool& tool, double part) noexcept;

  std::array<Vector3, maximum_tools> start_force_{}, start_torque_{};
  std::array<Ahead, maximum_tools> ahead_{};
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/proxy_motion.ipp>
#endif
