// From the pointer to the tools.
#pragma once

#include "drawn_surface.hpp"
#include "mouse_device.hpp"
#include "pointer_script.hpp"
#include "touch_scene.hpp"

#include <functional>
#include <vector>

namespace live {

/// Moves tools with the pointer. Without a button the active tool hovers over the surface under the pointer; pressing
/// the button sets it on the surface. While it is down, the tool moves as far as the pointer does: along the surface,
/// in the tangent plane, so that it stays as deep; a tool that grasps in the plane of the picture, within its range of
/// motion. So it never leaps to the pointer. The wheel pushes it away from the eye. Keys: Tab takes the next tool, G
/// grasps or lets go, U unplugs the device or plugs it in, H keeps the tool where it is.
class Hand {
 public:
  using Look = std::function<const DrawnSurface&()>;  ///< the surface at present

  Hand(Camera& camera, Look look) : camera_(&camera), look_(std::move(look)) {}
  /// A tool that the pointer moves; `radius`: how far its middle is from a surface that it touches [m].
  void add(MouseDevice& device, const Vector3& start, double radius) { tools_.push_back({&device, start, radius}); }
  void set_radius(std::size_t tool, double radius) { tools_[tool].radius = radius; }
  /// How far a tool that grasps moves from where it took hold.
  void set_range(const MotionRange& range) { range_ = range; }

  void handle(const PointerEvent& event);
  std::size_t active() const noexcept { return active_; }
  bool keeps_still() const noexcept { return still_; }
  bool grasps() const noexcept { return !tools_.empty() && tools_[active_].buttons != 0; }
  bool unplugged() const noexcept { return unplugged_; }
  /// Where the tools were asked to be [m].
  Vector3 target(std::size_t tool) const { return in_range(tools_[tool]); }

 private:
  struct Moved {
    MouseDevice* device;
    Vector3 target;  // of the pointer; that of a tool that grasps ends at its range
    double radius;
    std::uint32_t buttons = 0;
    Vector3 normal = Vector3::UnitZ();     // of the surface where it was set on it
    Vector3 grasped_at = Vector3::Zero();  // where it began to grasp
  };
  void hover(const PointerEvent& event);
  void press(const PointerEvent& event);
  void drag(const PointerEvent& event);
  void key(char key);
  Vector3 in_range(const Moved& tool) const;
  void send(Moved& tool, bool set_there = false);

  Camera* camera_;
  Look look_;
  std::vector<Moved> tools_;
  std::size_t active_ = 0;
  double x_ = 0.5, y_ = 0.5;  // of the pointer
  MotionRange range_;
  bool pressed_ = false, still_ = false, unplugged_ = false;
};

}  // namespace live
