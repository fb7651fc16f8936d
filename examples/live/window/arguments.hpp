// The command line of `live`.
#pragma once

#include <optional>
#include <string>

namespace live {

struct Arguments {
  std::string scene = "palpate", mesh, fix, touch;
  std::string composition;  ///< as the panel names it; empty: the first of the scene
  std::string device = "mouse", replay;
  std::string script;  ///< a file, or "scene": that of the scene; empty: the mouse
  std::string screenshot, record, out = ".";
  std::string film;             ///< prefix of PNG files, ten a second
  double seconds = 0.0;         ///< the window closes then; 0: never
  double screenshot_at = -1.0;  ///< [s] negative: at the end
  long frames = 0;              ///< the window closes then; 0: never
  int width = 1280, height = 800;
  bool virtual_time = false;  ///< a frame is 1/60 s, whatever it takes: the same in every run
  bool drawing = true, error_bars = true, reveal = false, stress = false;
  bool trouble = false;  ///< resizes, minimises, unplugs and plugs in meanwhile
};

/// Empty, after a message, when an argument is not understood.
std::optional<Arguments> read_arguments(int count, char** values);

}  // namespace live
