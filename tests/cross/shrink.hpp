// Reduces a scene while it fails.
#pragma once

#include "scene.hpp"

#include <functional>

namespace cross {

/// The plainest scene found by single changes of which `fails` is still true: fewer tools, ticks and cells, plainer
/// words, rounder numbers. `fails` is called at most `most` times.
Scene shrink(Scene scene, const std::function<bool(const Scene&)>& fails, int most = 200);

/// Number of values that differ from the plainest scene, and of tools.
int size_of(const Scene& scene);

}  // namespace cross
