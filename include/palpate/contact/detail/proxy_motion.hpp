// Where proxies go in a tick.
#pragma once

#include <palpate/contact/contact.hpp>

#include <array>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Moves the proxies of all tools: along with their devices, then from linearisation to linearisation to where the
/// answer has them. Says how far the next step goes and how much forces changed in the last. No allocation.
class ProxyMotion {
 public:
  using Tools = std::span<ContactTool>;
  /// How far the present force lets a proxy go.
  struct Ahead {
    Vector3 path = Vector3::Zero(),
            axis = Vector3::Zero();  ///< of the proxy; of the end of a capsule's axis of length 1
    double farthest = 0.0;           ///< way of any of its points, at most [m]
  };

  /// Takes the proxies along with their devices, across the contact force: from there the first linearisation is nearly
  /// right for a sphere that slides.
  static void slide(Tools tools) noexcept;
  /// Remembers the forces that a linearisation begins with.
  void begin(Tools tools) noexcept;
  /// `floor`: the least compliance of a contact [m/N], as TissueModel has it.
  void look_ahead(Tools tools, double floor) noexcept;
  const Ahead& ahead(std::size_t tool) const noexcept { return ahead_[tool]; }
  /// Moves the proxies to where the answer has them, as far as one linearisation may go; true when all are there.
  bool follow(Tools tools, double floor) noexcept;
  /// Of the tools' forces and torques since `begin`.
  double relative_change(Tools tools) const noexcept;

 private:
  static void turn(ContactTool& tool, double part) noexcept;

  std::array<Vector3, maximum_tools> start_force_{}, start_torque_{};
  std::array<Ahead, maximum_tools> ahead_{};
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/proxy_motion.ipp>
#endif
