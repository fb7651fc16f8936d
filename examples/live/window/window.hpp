// The window of the operating system and its input.
#pragma once

#include "../core/pointer_script.hpp"

#include <vector>

struct GLFWwindow;

namespace live {

/// A window with OpenGL 3.3, and Dear ImGui in it. Throws std::runtime_error where there is no display or no OpenGL.
class Window {
 public:
  Window(int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool is_closing() const;
  void close();
  /// Input since the last call, of the part of the window that the panel does not cover: `picture_width` pixels wide.
  std::vector<PointerEvent> poll(int picture_width);
  void begin_frame();  ///< of the panel
  void end_frame();    ///< draws the panel
  void swap();         ///< shows the frame; waits for the screen
  int width() const;   ///< pixels; 0 while minimised
  int height() const;
  void resize(int width, int height);
  void minimise(bool minimised);

 private:
  void on_move(double x, double y);
  void on_button(int button, bool down, int modifiers);
  void on_wheel(double steps, bool control);
  void on_key(int key);
  void add(PointerEvent event);

  GLFWwindow* window_ = nullptr;
  std::vector<PointerEvent> events_;
  double x_ = 0.5, y_ = 0.5;
  int picture_width_ = 1;
  enum class Drag { none, tool, orbit, pan } drag_ = Drag::none;
};

}  // namespace live
