// A scene as a program of the public interface.
#pragma once

#include "scene.hpp"

#include <string>

namespace cross {

/// A complete program that builds the body, tissue and tools of a scene with palpate's public headers only, follows the
/// paths, and prints every tenth tick: depth, contact force and flags of each tool. It has only what differs from the
/// defaults. Compile it with g++ -std=c++20 -O2 -I<palpate>/include -I<eigen> x.cpp -pthread.
/// Tissue with explicit steps is set up here, since the step that it takes depends on its mesh.
std::string to_program(const Scene& scene);

}  // namespace cross
