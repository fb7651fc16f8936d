// The command line of bench_tradeoff.
#pragma once

#include <span>
#include <string>

namespace tradeoff {

/// Options of a scene from the command line.
struct SceneOptions {
  std::string mesh;                  ///< file; empty: the organ of palpate
  std::string constrained, touched;  ///< selections as text (patches.hpp); empty: chosen
  std::string kind = "palpate";      ///< palpate, retract or grasp
  double youngs_modulus = 5e3, poisson_ratio = 0.45, density = 1060.0;
};

/// What the command line contains. Files are not read yet.
struct Arguments {
  SceneOptions scene;
  double budget = 500e-6;  ///< p99 of the time of a tick [s]; by default half of what 1 kHz allows
  double edge = 0.2;       ///< of elements under the spheres where the mesh is refined near them [radii]
  std::string out = ".", only, document;
  bool full = false;
};

/// Throws SetupError bad_argument for an option that does not exist, has no value or is given twice, a number that is
/// none or out of range, a second mesh, an unknown scene, a file that cannot be read, and for patches or scenes of the
/// wrong mesh.
Arguments parse_arguments(std::span<const std::string> words);

}  // namespace tradeoff
