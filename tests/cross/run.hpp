// Runs a scene: one record of every tool in every tick, in the units and axes of the scene itself.
#pragma once

#include "tissue.hpp"

#include <string>
#include <vector>

namespace cross {

/// How a scene is run, other than the scene itself states.
struct Manner {
  Change change{};
  std::string solver{};  ///< another one than the scene's; empty: that
  std::string member{};  ///< the same for the scene's member
  std::string pose{};    ///< the same for its pose
  int threads = 0;       ///< the same; 0: the scene's
  int capacity = -1;     ///< the same; -1: the scene's
  std::string cache_file{};
  int plays = 1;              ///< with a reset of servo and tissue in between; the last one is recorded
  bool new_servo = false;     ///< another servo for every play
  bool second_servo = false;  ///< another servo on the same tissue, whose tools stay in the air
  bool recorded = false;      ///< of two plays the first is recorded to a file, the second reads it
  bool frictionless = false;
  bool loaded_later = false;  ///< of tissue that moves: set up without loads, which then grow
  bool worker = false;        ///< steps and cuts in a background thread, ticks in real time
  bool reference = false;     ///< on a fine graded mesh of quadratic elements (reference.hpp)
};

/// A tool in a tick.
struct ToolTick {
  Vector3 position, proxy;   ///< [m]
  Vector3 force, torque;     ///< of the contact, before the gate [N], [N m]
  palpate::Status status{};  ///< with what the gate reported
  Vector3 rendered;          ///< force to the device [N]
  double bound = 0.0;        ///< of the error of the force [N]
  double of_points = 0.0;    ///< part of the bound: few points press, or some have no row [N]
  double depth = 0.0;        ///< below the surface at rest [m]
  bool finite = true;        ///< contact force and rendered force
};

struct Run {
  std::string refused;                       ///< kind of the SetupError; empty: it ran
  std::string message;                       ///< its message
  std::vector<std::vector<ToolTick>> ticks;  ///< [tick][tool]
  std::vector<double> imbalance;             ///< per tick: forces on vertices and tools together [N]
  double peak = 0.0;                         ///< largest force of any tool [N]
  double penetration = 0.0;                  ///< of surface vertices in spheres, at the end of the second phase [m]
  double left = 0.0;                         ///< displacement of the surface some steps after the end [m]
  int misrecorded = -1;                      ///< first tick whose force in a recording is not that rendered
  bool has_report = true;                    ///< the set-up report has memory where degrees of freedom are kept
  std::vector<std::string> notes;            ///< of the servo
  double work_in = 0.0;                      ///< largest work that the hands had done until any tick [J]
  double work = 0.0;                         ///< of the hands on the tissue over the whole path [J]
};

/// Runs a scene. Exceptions other than SetupError pass.
Run run(const Scene& scene, const Manner& manner = {});

}  // namespace cross
