#include "stage.hpp"

namespace live {

Stage::Stage(TouchScene scene, Clock clock, std::vector<std::unique_ptr<AnyDevice>> devices)
    : scene_(std::move(scene)),
      clock_(clock),
      camera_(scene_.camera),
      devices_(std::move(devices)),
      hand_(camera_, [this]() -> const DrawnSurface& { return look(); }),
      tools_(scene_.tools) {
  hand_.set_range(scene_.range);
  if (devices_.size() > tools_.size())
    raise(SetupErrorKind::bad_argument, "there are more devices than tools in this scene", "Choose the scene grasp");
  mice_.resize(devices_.size());
  for (std::size_t i = devices_.size(); i < tools_.size(); ++i) {
    auto mouse = std::make_unique<DeviceOf<MouseDevice>>(
        scene_.starts[i], clock == Clock::real ? DeviceClock::wall : DeviceClock::simulated);
    mice_.push_back(&mouse->device);
    hand_.add(mouse->device, scene_.starts[i], radius_of(tools_[i]));
    devices_.push_back(std::move(mouse));
  }
  for (const auto& device : devices_) taps_.push_back(std::make_unique<Tap>(*device, clock == Clock::real));
  logs_.resize(taps_.size());
}

void Stage::touch(std::unique_ptr<Organ> organ, const Tuning& tuning) {
  stop();
  organ_ = std::move(organ);
  surface_ = {};
  for (TickLog& log : logs_) log.clear();
  start(tuning);
}

void Stage::retune(const Tuning& tuning) {
  stop();
  if (!organ_) return;
  organ_->set_gravity(tuning.gravity);
  start(tuning);
}

void Stage::start(const Tuning& tuning) {
  tools_ = tuned_tools(scene_, tuning);
  for (std::size_t i = 0, moved = 0; i < tools_.size(); ++i)
    if (mice_[i] != nullptr) hand_.set_radius(moved++, radius_of(tools_[i]));
  const ServoOptions options = tuned_session(scene_, tuning);
  loop_ = clock_ == Clock::real ? start_real_time(*organ_, taps_, tools_, options)
                                : start_virtual_time(*organ_, taps_, tools_, options);
  if (clock_ == Clock::real) maker_ = std::make_unique<SurfaceMaker>(*organ_, snapshot(), field);
}

LoopReport Stage::stop() {
  if (!loop_) return {};
  LoopReport report = loop_->stop();  // the forces are zero first
  maker_.reset();
  loop_.reset();
  return report;
}

void Stage::run(double seconds, PointerScript& script) {
  if (!loop_) return;
  loop_->run(seconds, [&](double time) {
    script.play_until(time, [&](const PointerEvent& event) {
      hand_.handle(event);
      if (event.action == PointerAction::key && on_key) on_key(event);
    });
  });
  fetch();
  if (maker_) maker_->ask(snapshot(), field);
}

void Stage::fetch() {
  for (std::size_t i = 0; i < logs_.size(); ++i) logs_[i].fetch(*taps_[i]);
}

const DrawnSurface& Stage::look() {
  if (maker_) return maker_->newest();
  if (organ_) organ_->draw(snapshot(), field, surface_);
  return surface_;
}

void Stage::write_vtu(const std::string& path) {
  if (!organ_) return;
  const auto write = [&] { organ_->write_vtu(path, snapshot()); };
  maker_ ? maker_->between_surfaces(write) : write();
}

Vector3 Stage::rendered_force(std::size_t tool) const {
  return mice_[tool] != nullptr ? mice_[tool]->last_force() : Vector3::Zero();
}

}  // namespace live
