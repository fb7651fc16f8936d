// Motion of the proxies within a tick.
#pragma once

#include <palpate/contact/contact.hpp>

#include <array>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Moves the proxies of all tools: first with their devices, then from linearisation to linearisation to the positions
/// of the solution. Reports how far the next step goes and how much the forces changed in the last. No allocation.
class ProxyMotion {
 public:
  using Tools = std::span<ContactTool>;
  /// Displacement of a proxy to its goal under the present force.
  struct Ahead {
    Vector3 path = Vector3::Zero();  ///< of the proxy [m]
    Matrix3 turn = Matrix3::Zero();  ///< change of its rotation; zero for a sphere
    double farthest = 0.0;           ///< upper bound of the displacement of any of its points [m]
  };

  /// Moves the proxies with their devices, perpendicular to the contact force: this makes the first linearisation
  /// nearly exact for a sphere that slides.
  static void slide(Tools tools) noexcept;
  /// Begins a linearisation: stores the forces, and replaces a target that one linearisation may not reach by the
  /// farthest point on the path to it that it may reach.
  /// `floor`: the least compliance of a contact [m/N], as TissueModel has it.
  void begin(Tools tools, double floor) noexcept;
  /// Ends a linearisation: the targets are those of the devices again.
  void end(Tools tools) noexcept;
  /// Computes `ahead` of every tool.
  void look_ahead(Tools tools, double floor) noexcept;
  const Ahead& ahead(std::size_t tool) const noexcept { return ahead_[tool]; }
  /// Moves the proxies towards the positions of the solution, and the forces with them, by the part of the step that is
  /// returned: 1, or less where a proxy or the surface (`surface` [m]) would move farther than one linearisation may.
  /// A tool that nothing presses moves independently.
  double follow(Tools tools, double floor, double surface) noexcept;
  /// Whether all proxies got to the positions of the solution in the last step.
  bool arrived() const noexcept { return arrived_; }
  /// Change of the tools' forces and torques since `begin`, relative to a force `scale` [N].
  double relative_change(Tools tools, double scale) const noexcept;
  /// Ends a tick. With friction or at a thin plate the linearisations may go in a circle. When many ticks in turn have
  /// not converged although the devices hardly move, steps become shorter, until a device moves, or nothing presses.
  /// They also become longer again, after a time that doubles with every failure: shorter steps cost more of them.
  /// Returns whether the forces go back and forth from tick to tick although no device moves, or devices move steadily:
  /// every tick converges, to another state than the one before. Some ticks after it are reported, too. `presses`:
  /// whether a tool would penetrate without its force, or grasps; shorter steps leave a part of the forces of tools
  /// that have gone. `scale`: of the forces [N], as for `relative_change`.
  bool end_tick(Tools tools, bool converged, bool presses, double scale) noexcept;

 private:
  static constexpr int patience = 8;                          // ticks
  static constexpr int first_wait = 32, longest_wait = 4096;  // ticks with shorter steps before longer ones are tried
  static constexpr double least_part = 0.125, still = 0.01;   // still: path of a device in a tick, radii
  static constexpr double resting = 1e-4;                     // the same: it does not change the force
  static constexpr double alternating = 0.01;                 // change of a force per tick, back and forth, relative
  static constexpr double alternating_in_motion = 0.03;       // the same while devices move
  inline static double allowed_part(const ContactTool& tool, double path) noexcept;
  static void rotate(ContactTool& tool, double part) noexcept;
  enum class Pace : unsigned char { rests, steady, other };

  std::array<Vector3, maximum_tools> start_force_{}, start_torque_{}, target_{};
  /// Of a tool at the end of the last tick.
  struct Last {
    Vector3 force = Vector3::Zero(), target = Vector3::Zero();
    Vector3 path = Vector3::Zero();    ///< of its device in that tick
    Vector3 change = Vector3::Zero();  ///< of the force, while devices rest or move steadily
    int reversals = 0;                 ///< of that change, in turn
  };
  inline static Pace pace(const ContactTool& tool, const Last& last) noexcept;
  bool alternates(Tools tools, double scale) noexcept;

  std::array<Last, maximum_tools> last_{};
  std::array<bool, maximum_tools> active_{};
  std::array<Ahead, maximum_tools> ahead_{};
  double longest_part_ = 1.0;  // of a step
  int restless_ticks_ = 0;     // in turn, that took a whole step and have not converged
  int converged_ticks_ = 0;    // that converged with shorter steps
  int reported_ticks_ = 0;     // that are still reported
  Pace pace_ = Pace::other;    // of all tools in the last tick
  int wait_ = first_wait;
  bool clipped_ = false, arrived_ = true, took_whole_step_ = false;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/proxy_motion.ipp>
#endif
