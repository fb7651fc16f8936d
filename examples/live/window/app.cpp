#include "app.hpp"

#include "devices.hpp"
#include "screenshot.hpp"

#include <palpate/io/file.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace live {

namespace {

/// A range of colours that shows the field at the deformations of a scene.
void follow_range(const DrawnSurface& surface, Field field, PictureOptions& options) {
  if (surface.values.empty()) return;
  const double most = *std::ranges::max_element(surface.values);
  const double least = field == Field::von_mises ? 600.0 : 4e-3, wanted = std::max(least, 0.8 * most);
  options.low = 0.0;
  options.high = options.high == 1.0 ? wanted : options.high + 0.08 * (wanted - options.high);
}

}  // namespace

App::App(const Arguments& arguments) : arguments_(arguments), window_(arguments.width, arguments.height) {
  panel_.picture.reveal = arguments.reveal;
  panel_.tuning.error_bars = arguments.error_bars;
  open_scene(arguments.scene);
}

void App::open_scene(const std::string& name) {
  try {
    show_scene(arguments_.mesh.empty() ? make_scene(name)
                                       : make_own_scene(arguments_.mesh, arguments_.fix, arguments_.touch));
  } catch (const std::exception& error) {
    if (!stage_) show_scene(make_scene("palpate"));  // the message is in the window
    refuse(error);
  }
}

/// The message stays in the window until something else is tried.
void App::refuse(const std::exception& error) {
  panel_.refused = last_refused_ = error.what();
}

void App::show_scene(TouchScene scene) {
  if (builder_.busy()) builder_.take();
  const double friction = scene.session.contact.friction;
  auto devices = open_devices(arguments_);
  stage_ = std::make_unique<Stage>(std::move(scene), arguments_.virtual_time ? Clock::simulated : Clock::real,
                                   std::move(devices));
  stage_->on_key = [this](const PointerEvent& event) { key(event.key); };
  stage_->log().record(!arguments_.record.empty());
  panel_.tuning = {.friction = friction, .error_bars = arguments_.error_bars};
  panel_.trials.clear();
  panel_.refused.clear();
  const auto& all = stage_->scene().compositions;
  const auto named =
      std::ranges::find(all, arguments_.composition, [](Composition c) { return std::string(name_of(c)); });
  if (arguments_.stress) stage_->field = Field::von_mises;
  build(named == all.end() ? all.front() : *named);
}

void App::build(Composition composition) {
  if (builder_.busy()) return;
  panel_.refused.clear();
  building_ = composition;
  built_ = panel_.tuning;
  builder_.begin(stage_->scene(), composition, built_);
  panel_.building = true;
}

/// An organ that is refused changes nothing: the one before is touched on.
void App::finish_building() {
  if (!builder_.busy() || (!builder_.ready() && !arguments_.virtual_time)) return;
  panel_.building = false;
  try {
    stage_->touch(builder_.take(), panel_.tuning);
    panel_.composition = building_;
    script_ = {};
    if (arguments_.script == "scene")
      script_ = PointerScript(stage_->scene().script);
    else if (!arguments_.script.empty())
      script_ = PointerScript(io::read_file(arguments_.script));
    if (touch_ready_ == 0.0) touch_ready_ = elapsed();
  } catch (const std::exception& error) {
    refuse(error);
  }
}

int App::run() {
  while (!window_.is_closing() && !is_over()) {
    finish_building();
    handle_input();
    stage_->run(1.0 / 60.0, script_);
    note_trial(*stage_, panel_.composition, panel_.trials);
    if (arguments_.trouble) make_trouble();
    draw();
  }
  if (!arguments_.screenshot.empty() && !pictured_) {
    arguments_.drawing = true;
    for (int k = 0; k < 3; ++k) draw();  // the panel finds its widths in the first ones
    write_picture(arguments_.screenshot);
  }
  total_ = stage_->stop();
  write_recordings();
  report();
  for (std::size_t i = 0; i < stage_->tools().size(); ++i)
    if (stage_->rendered_force(i).norm() > 0.0) return 1;
  return 0;
}

void App::handle_input() {
  for (const PointerEvent& event : window_.poll(window_.width() - panel_width)) {
    if (event.action == PointerAction::key) key(event.key);
    if (script_.empty() || event.action == PointerAction::orbit || event.action == PointerAction::zoom)
      stage_->handle(event);
  }
}

void App::key(char key) {
  try {
    if (key == 'L') panel_.picture.reveal = !panel_.picture.reveal;
    if (key == 'P') write_picture(file("picture.png"));
    if (key == 'V' && stage_->organ() != nullptr) {
      stage_->write_vtu(file("organ.vtu"));
      panel_.news = "wrote " + file("organ.vtu");
    }
    if (key == 'R') {
      TickLog& log = stage_->log();
      log.record(!log.recording());
      if (!log.recording() && !log.recorded().empty()) {
        write_recording(file("recording.csv"), log.recorded());
        panel_.news = "wrote " + file("recording.csv");
      }
    }
  } catch (const std::exception& error) {
    panel_.news = error.what();
  }
  const auto& all = stage_->scene().compositions;
  if (key >= '1' && static_cast<std::size_t>(key - '1') < all.size()) build(all[static_cast<std::size_t>(key - '1')]);
}

void App::draw() {
  const double begin = elapsed();
  const int width = window_.width(), height = window_.height();
  if (width > panel_width && height > 0 && arguments_.drawing) {
    glViewport(0, 0, width - panel_width, height);
    if (!arguments_.virtual_time) stage_->camera().aspect = static_cast<double>(width - panel_width) / height;
    follow_range(stage_->look(), stage_->field, panel_.picture);
    picture_.draw(*stage_, panel_.picture);
    glViewport(0, 0, width, height);
    window_.begin_frame();
    const PanelWishes wishes = draw_panel(*stage_, panel_, width, height);
    window_.end_frame();
    drawing_ += elapsed() - begin;
    if (!pictured_ && arguments_.screenshot_at >= 0.0 && present() >= arguments_.screenshot_at && stage_->running()) {
      write_picture(arguments_.screenshot);
      pictured_ = true;
    }
    film();
    window_.swap();
    obey(wishes);
  }
  ++frames_;
  if (first_frame_ == 0.0) first_frame_ = elapsed();
  const double now = elapsed(), frame = now - last_frame_;
  if (frames_ > 10) longest_frame_ = std::max(longest_frame_, frame);
  panel_.frames_per_second += 0.05 * (1.0 / std::max(1e-4, frame) - panel_.frames_per_second);
  if (!arguments_.virtual_time && frame < 1.0 / 60.0)  // where the screen does not set the pace
    platform::sleep_until_ns(platform::wall_ns() + static_cast<std::int64_t>(1e9 * (1.0 / 60.0 - frame)));
  last_frame_ = elapsed();
}

void App::obey(const PanelWishes& wishes) {
  for (const char k : wishes.keys) {
    stage_->handle({.action = PointerAction::key, .key = k});
    key(k);
  }
  if (wishes.scene) {
    arguments_.mesh.clear();
    return open_scene(*wishes.scene);
  }
  if (wishes.composition || wishes.rebuild) return build(wishes.composition.value_or(panel_.composition));
  if (!wishes.retune) return;
  try {
    stage_->retune(panel_.tuning);
  } catch (const std::exception& error) {
    refuse(error);
  }
}

/// What goes wrong in the life of a window, one after the other.
void App::make_trouble() {
  switch (frames_ % 240) {
    case 40:
      return window_.resize(900, 500);
    case 70:
      return window_.resize(500, 300);
    case 90:
      return window_.resize(1280, 800);
    case 110:
      return window_.minimise(true);
    case 130:
      return window_.minimise(false);
    case 150:
    case 170:
      return stage_->handle({.action = PointerAction::key, .key = 'U'});
    case 190:
      return key('2');
    default:
      return;
  }
}

double App::present() const {
  return stage_->loop() != nullptr ? stage_->loop()->time() : 0.0;
}

bool App::is_over() const {
  return (arguments_.frames > 0 && frames_ >= arguments_.frames) ||
         (arguments_.seconds > 0.0 && (arguments_.virtual_time ? present() : elapsed()) >= arguments_.seconds);
}

std::string App::file(const char* name) const {
  return (std::filesystem::path(arguments_.out) / name).string();
}

void App::write_picture(const std::string& path) {
  write_screenshot(path, window_.width(), window_.height());
  panel_.news = "wrote " + path;
}

void App::film() {
  if (arguments_.film.empty() || !stage_->running() || present() < 0.1 * filmed_) return;
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "%04d.png", ++filmed_);
  write_screenshot(arguments_.film + number.data(), window_.width(), window_.height());
}

void App::write_recordings() {
  if (arguments_.record.empty()) return;
  stage_->fetch();
  write_recording(arguments_.record, stage_->log().recorded());
}

void App::report() const {
  if (!last_refused_.empty()) std::cout << "refused: " << last_refused_ << '\n';
  std::cout << frames_ << " frames in " << elapsed() << " s; first frame after " << first_frame_ << " s, touch after "
            << touch_ready_ << " s; drawing " << 1e3 * drawing_ / static_cast<double>(frames_)
            << " ms per frame, longest frame " << 1e3 * longest_frame_ << " ms\n";
  if (arguments_.virtual_time)
    std::cout << total_.ticks << " ticks in virtual time, peak force " << total_.peak_force << " N, status "
              << total_.status << '\n';
  else
    std::cout << total_;
}

}  // namespace live
