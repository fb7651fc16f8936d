#include "hand.hpp"

namespace live {

namespace {
constexpr double hover_height = 4e-3;  // [m]
}

void Hand::handle(const PointerEvent& event) {
  switch (event.action) {
    case PointerAction::orbit:
      return camera_->orbit(event.x, event.y);
    case PointerAction::pan:
      return camera_->pan(event.x, event.y);
    case PointerAction::zoom:
      return camera_->zoom(event.amount);
    case PointerAction::key:
      return key(event.key);
    default:
      break;
  }
  if (tools_.empty() || still_) return;
  switch (event.action) {
    case PointerAction::press:
      press(event);
      break;
    case PointerAction::release:
      pressed_ = false;
      hover(event);
      break;
    case PointerAction::wheel: {
      Moved& tool = tools_[active_];
      tool.target += event.amount * camera_->forward();
      return send(tool);
    }
    default:
      pressed_ ? drag(event) : hover(event);
  }
  x_ = event.x;
  y_ = event.y;
}

void Hand::drag(const PointerEvent& event) {
  Moved& tool = tools_[active_];
  const Vector3 plane = tool.buttons != 0 ? camera_->forward() : tool.normal;
  tool.target +=
      camera_->in_plane(event.x, event.y, tool.target, plane) - camera_->in_plane(x_, y_, tool.target, plane);
  send(tool);
}

/// A tool that grasps stays where it is.
void Hand::hover(const PointerEvent& event) {
  Moved& tool = tools_[active_];
  if (tool.buttons != 0) return;
  const Ray ray = camera_->ray(event.x, event.y);
  if (const auto hit = look_().hit(ray))
    tool.target = hit->point + (tool.radius + hover_height) * hit->normal;
  else
    tool.target = camera_->in_plane(event.x, event.y, tool.target);
  send(tool);
}

void Hand::press(const PointerEvent& event) {
  Moved& tool = tools_[active_];
  pressed_ = true;
  if (tool.buttons != 0) return;
  tool.normal = -camera_->forward();
  const auto hit = look_().hit(camera_->ray(event.x, event.y));
  if (!hit) return;
  tool.normal = hit->normal;
  tool.target = hit->point + tool.radius * hit->normal;
  send(tool, true);
}

void Hand::key(char key) {
  if (tools_.empty()) return;
  Moved& tool = tools_[active_];
  switch (key) {
    case '\t':
      active_ = (active_ + 1) % tools_.size();
      pressed_ = false;
      return;
    case 'H':
      still_ = !still_;
      return;
    case 'G':
      tool.target = in_range(tool);
      tool.buttons ^= 1u;
      tool.grasped_at = tool.target;
      return send(tool);
    case 'U':
      unplugged_ = !unplugged_;
      for (Moved& t : tools_) send(t);
      return;
    default:
      return;
  }
}

Vector3 Hand::in_range(const Moved& tool) const {
  return tool.buttons == 0 ? tool.target : Vector3(tool.grasped_at + range_.limited(tool.target - tool.grasped_at));
}

void Hand::send(Moved& tool, bool set_there) {
  tool.device->move({in_range(tool), tool.buttons, set_there, !unplugged_});
}

}  // namespace live
