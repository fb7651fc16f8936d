// The panel beside the picture: what is measured, and what can be changed.
#pragma once

#include "../core/stage.hpp"
#include "picture.hpp"
#include "trials.hpp"

#include <optional>
#include <string>

namespace live {

/// What the user asked for in a frame.
struct PanelWishes {
  std::optional<Composition> composition;
  std::optional<std::string> scene;
  bool retune = false;   ///< the sliders of the session changed: friction, coupling, radius, gravity
  bool rebuild = false;  ///< those of the organ: stiffness
  std::string keys;      ///< buttons that do what a key does
};

/// What the panel shows apart from the stage.
struct PanelState {
  Composition composition = Composition::smoothed;
  Tuning tuning;
  PictureOptions picture;
  Trials trials;
  bool building = false;
  std::string refused;  ///< message of a set-up that was refused
  std::string news;     ///< last file written
  double frames_per_second = 0.0;
};

constexpr int panel_width = 372;  ///< pixels

PanelWishes draw_panel(Stage& stage, PanelState& state, int window_width, int window_height);

}  // namespace live
