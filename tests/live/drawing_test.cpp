// The window never waits for the organ: a surface that takes long is computed beside it.
#include "core/stage.hpp"

#include "catch.hpp"

#include <chrono>
#include <thread>

using namespace palpate;

namespace {

/// Draws only while the gate is open, as a tissue that is being cut.
class GatedOrgan final : public live::Organ {
 public:
  GatedOrgan(std::unique_ptr<live::Organ> organ, std::atomic<bool>& open) : organ_(std::move(organ)), open_(open) {}

  const SetupReport& report() const override { return organ_->report(); }
  TissueView view() override { return organ_->view(); }
  std::unique_ptr<HapticServo> make_servo(const std::vector<Tool>& tools, const ServoOptions& options) override {
    return organ_->make_servo(tools, options);
  }
  void set_gravity(const Vector3& gravity) override { organ_->set_gravity(gravity); }
  double work_interval() const override { return organ_->work_interval(); }
  void work() override { organ_->work(); }
  std::unique_ptr<BackgroundWorker> start_worker() override { return organ_->start_worker(); }
  bool draw(const ServoSnapshot& snapshot, live::Field field, live::DrawnSurface& surface) override {
    open_.wait(false);
    const bool drawn = organ_->draw(snapshot, field, surface);
    surface.revision += ++drawings_;
    return drawn;
  }
  bool has(live::Field field) const override { return organ_->has(field); }
  double least_volume_ratio(const ServoSnapshot& snapshot) override { return organ_->least_volume_ratio(snapshot); }
  void write_vtu(const std::string& path, const ServoSnapshot& snapshot) override { organ_->write_vtu(path, snapshot); }
  live::DrawnSurface region(const std::string& name) const override { return organ_->region(name); }

 private:
  std::unique_ptr<live::Organ> organ_;
  std::atomic<bool>& open_;
  unsigned long drawings_ = 0;
};

/// Triangles with all, and with some but not all points on a wound.
std::array<int, 2> count_wounds(const live::DrawnSurface& surface) {
  std::array<int, 2> count{};
  for (const auto& t : surface.triangles) {
    int points = 0;
    for (const int p : t) points += surface.values[static_cast<std::size_t>(p)] == live::DrawnSurface::wound ? 1 : 0;
    if (points > 0) ++count[points == 3 ? 0 : 1];
  }
  return count;
}

}  // namespace

TEST_CASE("while a surface is not ready, the window shows the one before and does not wait", "[live][drawing]") {
  const live::TouchScene scene = live::make_scene("beating");
  std::atomic<bool> open{true};
  live::Stage stage(scene, live::Clock::real);
  const live::Tuning tuning{.error_bars = false};
  stage.touch(std::make_unique<GatedOrgan>(live::make_organ(scene, live::Composition::beating, tuning), open), tuning);
  live::PointerScript nothing;
  CHECK_FALSE(stage.look().triangles.empty());  // there is a surface from the beginning

  open = false;
  for (int k = 0; k < 3; ++k) {  // the thread that draws comes to the gate
    stage.run(0.0, nothing);
    stage.look();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const unsigned long shown = stage.look().revision;
  for (int k = 0; k < 1000; ++k) {  // would end in a deadlock if one of these waited for the gate
    stage.run(0.0, nothing);
    stage.handle({.action = live::PointerAction::move, .x = 0.5, .y = 0.5});
    REQUIRE(stage.look().revision == shown);
  }
  open = true;
  open.notify_all();
  unsigned long later = shown;
  for (int k = 0; k < 2000 && later == shown; ++k) {
    stage.run(0.0, nothing);
    later = stage.look().revision;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(later != shown);
  stage.stop();
}

TEST_CASE("a cut in the scene shows wounds in a colour of their own", "[live][drawing][cut]") {
  const live::TouchScene scene = live::make_scene("cut");
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(live::make_organ(scene, scene.compositions.front(), {.error_bars = false}), {.error_bars = false});
  CHECK(count_wounds(stage.look()) == std::array<int, 2>{0, 0});
  live::PointerScript script(scene.script);
  stage.run(2.4, script);
  const auto [wounds, mixed] = count_wounds(stage.look());
  CHECK(wounds > 0);
  CHECK(wounds % 2 == 0);  // both sides of every opened face
  CHECK(mixed == 0);
}
