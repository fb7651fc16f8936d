#include "loop.hpp"

#include <chrono>

namespace live {

namespace {

using Steady = std::chrono::steady_clock;

class RealTimeLoop final : public Loop {
 public:
  RealTimeLoop(Organ& organ, Taps& taps, const std::vector<Tool>& tools, const ServoOptions& options)
      : tissue_(organ.view()) {
    if (taps.size() == 1)
      session_.emplace(*taps[0], tissue_, tools, options);
    else
      session_.emplace(std::tie(*taps[0], *taps[1]), tissue_, tools, options);
    worker_ = organ.start_worker();
    session_->start({.real_time = true});
  }
  ~RealTimeLoop() override { session_.reset(); }  // before the worker: ticks end first

  const ServoSnapshot& snapshot() override { return session_->snapshot(); }
  void run(double, const std::function<void(double)>& before_tick) override { before_tick(time()); }
  double time() const override { return std::chrono::duration<double>(Steady::now() - start_).count(); }
  LoopReport stop() override {
    LoopReport report = session_->stop();
    worker_->stop();
    return report;
  }
  WorkerReport work_report() const override { return worker_->report(); }

 private:
  TissueView tissue_;
  std::unique_ptr<BackgroundWorker> worker_;
  std::optional<HapticSession> session_;
  Steady::time_point start_ = Steady::now();
};

class VirtualTimeLoop final : public Loop {
 public:
  VirtualTimeLoop(Organ& organ, Taps& taps, const std::vector<Tool>& tools, const ServoOptions& options)
      : organ_(&organ), taps_(&taps), states_(taps.size()) {
    std::vector<DeviceLimits> limits;
    for (const auto& tap : taps) limits.push_back(tap->limits());
    servo_ = organ.make_servo(tools, servo_options(limits, tools.size(), options));
    for (const auto& tap : taps) tap->start();
  }
  ~VirtualTimeLoop() override { stop(); }

  const ServoSnapshot& snapshot() override { return servo_->read_snapshot(); }
  void run(double seconds, const std::function<void(double)>& before_tick) override {
    const auto end = ticks_ + static_cast<std::uint64_t>(std::llround(1e3 * seconds));
    while (ticks_ < end) {
      before_tick(time());
      tick();
    }
  }
  double time() const override { return 1e-3 * static_cast<double>(ticks_); }
  LoopReport stop() override {
    for (const auto& tap : *taps_) {
      tap->write(GatedForce{});
      tap->stop();
    }
    servo_->release();
    return report_;
  }
  WorkerReport work_report() const override { return {}; }

 private:
  void tick() {
    if (time() >= next_work_ - 1e-9) {
      organ_->work();
      next_work_ += organ_->work_interval();
    }
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = (*taps_)[i]->read();
    const std::span<const GatedForce> forces = servo_->tick(states_);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      report_.peak_force = std::max(report_.peak_force, forces[i].force().norm());
      report_.status.count(forces[i].status | (*taps_)[i]->write(forces[i]));
    }
    report_.ticks = ++ticks_;
  }

  Organ* organ_;
  Taps* taps_;
  std::vector<ToolState> states_;
  std::unique_ptr<HapticServo> servo_;
  LoopReport report_;
  std::uint64_t ticks_ = 0;
  double next_work_ = 0.0;
};

}  // namespace

std::unique_ptr<Loop> start_real_time(Organ& organ, Taps& taps, const std::vector<Tool>& tools,
                                      const ServoOptions& options) {
  return std::make_unique<RealTimeLoop>(organ, taps, tools, options);
}
std::unique_ptr<Loop> start_virtual_time(Organ& organ, Taps& taps, const std::vector<Tool>& tools,
                                         const ServoOptions& options) {
  return std::make_unique<VirtualTimeLoop>(organ, taps, tools, options);
}

}  // namespace live
