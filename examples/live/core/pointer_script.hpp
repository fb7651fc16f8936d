// Events of the pointer, and scripts of them: what a hand with a mouse does, without a hand.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace live {

enum class PointerAction {
  move,     ///< to x, y
  press,    ///< the left button, at x, y: sets the tool on the surface
  release,  ///< lifts the tool
  wheel,    ///< pushes the tool into the surface by `amount` [m]
  orbit,    ///< moves the camera, by x, y
  pan,
  zoom,  ///< by `amount` steps
  key,   ///< `key`
};

struct PointerEvent {
  PointerAction action = PointerAction::move;
  double time = 0.0;        ///< [s] since the start
  double x = 0.0, y = 0.0;  ///< in the picture: from 0, 0 (top left) to 1, 1
  double amount = 0.0;
  char key = 0;
};

/// Scripted input. One event per line; # begins a comment; a range of times is divided into steps of 1/60 s that start
/// and end gently:
///   0.2 move 0.5 0.4
///   0.5 press 0.5 0.4
///   0.5..1.5 push 6          millimetres, into the surface
///   1.5..2.5 drag 0.6 0.4    from where the pointer is
///   2.6 release
///   2.8 key G
class PointerScript {
 public:
  PointerScript() = default;
  /// Throws SetupError(bad_file) naming the line.
  explicit PointerScript(std::string_view text);

  /// Calls `handle` for all events up to a time [s] that were not yet handled. The script repeats.
  template <class Handle>
  void play_until(double time, Handle&& handle) {
    while (!events_.empty() && start_ + events_[next_].time <= time) {
      PointerEvent event = events_[next_];
      event.time += start_;
      handle(event);
      if (++next_ < events_.size()) continue;
      next_ = 0;
      start_ += duration();
    }
  }
  bool empty() const noexcept { return events_.empty(); }
  double duration() const noexcept { return events_.empty() ? 0.0 : events_.back().time + 0.2; }  ///< [s]
  const std::vector<PointerEvent>& events() const noexcept { return events_; }

 private:
  void add_line(const std::string& line, int number);

  std::vector<PointerEvent> events_;
  std::size_t next_ = 0;
  double start_ = 0.0, x_ = 0.5, y_ = 0.5;
};

}  // namespace live
