#include "window.hpp"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace live {

namespace {

Window& of(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

[[noreturn]] void fail(const std::string& what) {
  const char* why = nullptr;
  glfwGetError(&why);
  glfwTerminate();
  throw std::runtime_error(what + (why != nullptr ? std::string(": ") + why : std::string()) +
                           ". Without a screen: xvfb-run -s \"-screen 0 1280x800x24\" ...");
}

GLFWwindow* open_window(int width, int height, int samples) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SAMPLES, samples);
  GLFWwindow* window = glfwCreateWindow(width, height, "palpate", nullptr, nullptr);
  if (window == nullptr) fail("there is no window with OpenGL 3.3");
  glfwMakeContextCurrent(window);
  return window;
}

/// Smooth edges cost a processor that draws in software half of its frames: there the window has none.
GLFWwindow* open_window(int width, int height) {
  if (glfwInit() != GLFW_TRUE) fail("there is no display");
  GLFWwindow* window = open_window(width, height, 0);
  const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (renderer.find("llvmpipe") == renderer.npos && renderer.find("softpipe") == renderer.npos) {
    glfwDestroyWindow(window);
    window = open_window(width, height, 4);
  }
  glfwSwapInterval(1);
  return window;
}

void dress() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.FrameRounding = style.GrabRounding = 4.0F;
  style.WindowBorderSize = 0.0F;
  style.WindowPadding = {12.0F, 8.0F};
  style.FramePadding = {5.0F, 2.0F};
  style.ItemSpacing = {6.0F, 3.0F};
  style.CellPadding = {4.0F, 1.0F};
  style.Colors[ImGuiCol_WindowBg] = {0.13F, 0.15F, 0.18F, 1.0F};
  style.Colors[ImGuiCol_Button] = style.Colors[ImGuiCol_FrameBg] = {0.22F, 0.25F, 0.30F, 1.0F};
  style.Colors[ImGuiCol_ButtonHovered] = style.Colors[ImGuiCol_FrameBgHovered] = {0.30F, 0.35F, 0.42F, 1.0F};
  style.Colors[ImGuiCol_ButtonActive] = {0.05F, 0.46F, 0.50F, 1.0F};
  style.Colors[ImGuiCol_SliderGrab] = style.Colors[ImGuiCol_CheckMark] = {0.20F, 0.68F, 0.70F, 1.0F};
  style.Colors[ImGuiCol_Header] = {0.18F, 0.21F, 0.25F, 1.0F};
  for (const char* font : {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/System/Library/Fonts/Helvetica.ttc",
                           "C:/Windows/Fonts/segoeui.ttf"})
    if (std::filesystem::exists(font)) {
      ImGui::GetIO().Fonts->AddFontFromFileTTF(font, 13.0F);
      break;
    }
  ImGui::GetIO().IniFilename = nullptr;
}

}  // namespace

Window::Window(int width, int height) : window_(open_window(width, height)) {
  glfwSetWindowUserPointer(window_, this);
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { of(w).on_move(x, y); });
  glfwSetMouseButtonCallback(
      window_, [](GLFWwindow* w, int b, int action, int mods) { of(w).on_button(b, action == GLFW_PRESS, mods); });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    of(w).on_wheel(y, glfwGetKey(w, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS);
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
    if (action != GLFW_RELEASE) of(w).on_key(key);
  });
  ImGui::CreateContext();
  dress();
  ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the functions above, too
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::is_closing() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}
void Window::close() {
  glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

std::vector<PointerEvent> Window::poll(int picture_width) {
  picture_width_ = std::max(1, picture_width);
  glfwPollEvents();
  return std::exchange(events_, {});
}

void Window::begin_frame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}
void Window::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}
void Window::swap() {
  glfwSwapBuffers(window_);
}

int Window::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return width;
}
int Window::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return height;
}
void Window::resize(int width, int height) {
  glfwSetWindowSize(window_, width, height);
}
void Window::minimise(bool minimised) {
  minimised ? glfwIconifyWindow(window_) : glfwRestoreWindow(window_);
}

void Window::add(PointerEvent event) {
  event.time = glfwGetTime();
  events_.push_back(event);
}

void Window::on_move(double x, double y) {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  if (width <= 0 || height <= 0) return;
  const double dx = x / picture_width_ - x_, dy = y / height - y_;
  x_ += dx;
  y_ += dy;
  if (drag_ == Drag::none && ImGui::GetIO().WantCaptureMouse) return;
  switch (drag_) {
    case Drag::orbit:
      return add({.action = PointerAction::orbit, .x = dx, .y = dy});
    case Drag::pan:
      return add({.action = PointerAction::pan, .x = dx, .y = dy});
    default:
      return add({.action = PointerAction::move, .x = x_, .y = y_});
  }
}

void Window::on_button(int button, bool down, int modifiers) {
  if (!down) {
    if (drag_ == Drag::tool) add({.action = PointerAction::release, .x = x_, .y = y_});
    drag_ = Drag::none;
    return;
  }
  if (ImGui::GetIO().WantCaptureMouse) return;
  if (button == GLFW_MOUSE_BUTTON_LEFT && (modifiers & GLFW_MOD_SHIFT) == 0) {
    drag_ = Drag::tool;
    add({.action = PointerAction::press, .x = x_, .y = y_});
  } else {
    drag_ = button == GLFW_MOUSE_BUTTON_MIDDLE ? Drag::pan : Drag::orbit;
  }
}

void Window::on_wheel(double steps, bool control) {
  if (ImGui::GetIO().WantCaptureMouse) return;
  if (control)
    add({.action = PointerAction::zoom, .amount = steps});
  else
    add({.action = PointerAction::wheel, .x = x_, .y = y_, .amount = 1e-3 * steps});
}

void Window::on_key(int key) {
  if (ImGui::GetIO().WantTextInput) return;
  if (key == GLFW_KEY_ESCAPE) return close();
  if (key == GLFW_KEY_W || key == GLFW_KEY_S)
    return add({.action = PointerAction::wheel, .amount = key == GLFW_KEY_W ? 5e-4 : -5e-4});
  if (key == GLFW_KEY_TAB) key = '\t';
  if (key < 128) add({.action = PointerAction::key, .key = static_cast<char>(key)});
}

}  // namespace live
