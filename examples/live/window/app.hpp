// The program: a stage, a window, and what happens in a frame.
#pragma once

#include "arguments.hpp"
#include "organ_builder.hpp"
#include "panel.hpp"
#include "window.hpp"

#include <chrono>
#include <memory>

namespace live {

class App {
 public:
  explicit App(const Arguments& arguments);
  /// Returns the exit code.
  int run();

 private:
  using Steady = std::chrono::steady_clock;

  void open_scene(const std::string& name);
  void show_scene(TouchScene scene);
  void refuse(const std::exception& error);
  void build(Composition composition);
  void finish_building();
  void handle_input();
  void key(char key);
  void draw();
  void obey(const PanelWishes& wishes);
  void make_trouble();
  void write_picture(const std::string& path);
  void film();
  void write_recordings();
  std::string file(const char* name) const;
  double elapsed() const { return std::chrono::duration<double>(Steady::now() - start_).count(); }
  double present() const;  ///< [s] of the script and of --at
  bool is_over() const;
  void report() const;

  Arguments arguments_;
  Steady::time_point start_ = Steady::now();
  Window window_;
  Picture picture_;
  std::unique_ptr<Stage> stage_;
  OrganBuilder builder_;
  Composition building_ = Composition::smoothed;
  Tuning built_;
  PanelState panel_;
  PointerScript script_;
  long frames_ = 0;
  double first_frame_ = 0.0, touch_ready_ = 0.0, drawing_ = 0.0, longest_frame_ = 0.0, last_frame_ = 0.0;
  bool pictured_ = false;
  int filmed_ = 0;  // frames
  std::string last_refused_;
  LoopReport total_;
};

}  // namespace live
