// live: touch a soft organ with the mouse, or with a haptic device.
//
//   live [MESH --fix GROUP --touch GROUP] [--scene palpate|retract|grasp|cut|beating] [--solver NAME] [--device NAME]
//   ...
//
// Where to read on:
//
//   scenes/         what is touched: one file per scene, each a tutorial of its own
//   organs/         what it is computed with: one file per composition of element, material and solver
//   core/           mouse, hand, loop: everything that also runs without a window (live_headless)
//   window/         window, picture, panel
//
// Three threads: the haptic thread of HapticSession ticks at 1 kHz; a BackgroundWorker steps and cuts; this one draws.
// None waits for another: the picture reads snapshots, the mouse and the ticks go through queues (SpscRing).
#include "window/app.hpp"

#include <iostream>

int main(int count, char** values) {
  const auto arguments = live::read_arguments(count, values);
  if (!arguments) return 2;
  try {
    return live::App(*arguments).run();
  } catch (const std::exception& error) {
    std::cerr << "live: " << error.what() << '\n';
    return 2;
  }
}
