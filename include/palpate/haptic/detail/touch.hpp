// A tool of a servo at one tissue.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/servo_blade.hpp>
#include <palpate/haptic/detail/tool_input.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A tool at one tissue. The contact tool belongs to an array, since the contact problem takes those of all tools.
struct Touch {
  std::size_t number;  // of the tool
  ContactTool& tool;   // in the frame of the tissue; not active if it is a blade
  ToolInput input;
  bool is_blade = false;
  std::unique_ptr<ServoBlade> blade{};  // null for other tools, and where the tissue cannot be cut
  ForceError error{};
  double correction = 1.0;    // factor of the force: ServoOptions::corrected_force
  bool lost_contact = false;  // in the last tick
  // By which the forces of other tissues move the target of the tool, world frame: SharedTools.
  Vector3 shift = Vector3::Zero();            // [m]
  Vector3 rotation = Vector3::Zero();         // [rad]
  Vector3 rotation_change = Vector3::Zero();  // of `rotation`, since the tick before

  /// Whether the tissue exerts a force on it.
  bool presses() const noexcept {
    return !(tool.force.squaredNorm() == 0.0) || (blade && !(blade->force().squaredNorm() == 0.0));
  }

  void reset() noexcept {
    input.reset();
    tool.reset();
    if (blade) blade->reset();
    error = {};
    correction = 1.0;
    lost_contact = false;
    shift.setZero();
    rotation.setZero();
    rotation_change.setZero();
  }
};

}}}  // namespace palpate::detail
