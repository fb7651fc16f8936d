// A scene that is being played: its organ, the devices, the hand, and the loop. The window and the headless run use the
// same one.
#pragma once

#include "hand.hpp"
#include "loop.hpp"
#include "surface_maker.hpp"
#include "tick_log.hpp"

#include <memory>
#include <vector>

namespace live {

enum class Clock { real, simulated };

class Stage {
 public:
  /// Tools are moved by the mouse, or by the devices that are given, which replace the first mice.
  Stage(TouchScene scene, Clock clock, std::vector<std::unique_ptr<AnyDevice>> devices = {});
  ~Stage() { stop(); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Begins to touch this organ: stops the loop on the one before. Throws SetupError; then nothing runs.
  void touch(std::unique_ptr<Organ> organ, const Tuning& tuning);
  /// The same organ with other tools, coupling, friction or gravity.
  void retune(const Tuning& tuning);
  /// Ends the loop. The forces of all devices are zero.
  LoopReport stop();

  bool running() const noexcept { return loop_ != nullptr; }
  void handle(const PointerEvent& event) { hand_.handle(event); }
  /// Plays a script for so long, see Loop::run, and fetches the ticks.
  void run(double seconds, PointerScript& script);
  void fetch();  ///< the ticks so far
  /// The surface at present; in real time the newest that is complete, so that nobody waits for a cut. Valid until the
  /// next call.
  const DrawnSurface& look();
  /// Uses the organ while it is not drawn.
  void write_vtu(const std::string& path);
  const ServoSnapshot& snapshot() { return loop_ ? loop_->snapshot() : nothing_; }

  const TouchScene& scene() const noexcept { return scene_; }
  Organ* organ() noexcept { return organ_.get(); }
  Loop* loop() noexcept { return loop_.get(); }
  const TickLog& log(std::size_t tool = 0) const noexcept { return logs_[tool]; }
  TickLog& log(std::size_t tool = 0) noexcept { return logs_[tool]; }
  Hand& hand() noexcept { return hand_; }
  Camera& camera() noexcept { return camera_; }
  const std::vector<Tool>& tools() const noexcept { return tools_; }
  /// Force that a device renders now [N]; for tools that a mouse moves.
  Vector3 rendered_force(std::size_t tool) const;

  Field field = Field::displacement;
  std::function<void(const PointerEvent&)> on_key;  ///< keys that the hand does not know

 private:
  void start(const Tuning& tuning);

  TouchScene scene_;
  Clock clock_;
  Camera camera_;
  std::vector<std::unique_ptr<AnyDevice>> devices_;
  std::vector<MouseDevice*> mice_;  // per tool, null: another device
  Taps taps_;
  std::vector<TickLog> logs_;  // per tool
  Hand hand_;
  std::unique_ptr<Organ> organ_;
  std::vector<Tool> tools_;
  std::unique_ptr<Loop> loop_;
  std::unique_ptr<SurfaceMaker> maker_;  // in real time
  ServoSnapshot nothing_;
  DrawnSurface surface_;
};

}  // namespace live
