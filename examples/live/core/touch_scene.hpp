// What a scene of the window consists of. Every scene is a file of its own in ../scenes.
#pragma once

#include <palpate/contact/tools.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>

#include "camera.hpp"

#include <functional>
#include <string>
#include <vector>

namespace live {

/// Element, material and solver of a model; the names are what the panel shows.
enum class Composition { tet4, smoothed, tet10, quasi_newton, cuttable, beating };
const char* name_of(Composition c);

/// Elastic constants of a part of the organ.
struct Tissue {
  std::string region;           ///< empty: everywhere
  double youngs_modulus = 5e3;  ///< [Pa]
  double poisson_ratio = 0.45;
  double density = 1060.0;  ///< [kg/m^3]
};

/// How far a tool that grasps moves from where it took hold.
struct MotionRange {
  double radius = infinity;          ///< [m] in all directions
  Vector3 inward = Vector3::Zero();  ///< unit: into the organ
  double most_inward = infinity;     ///< [m] in that direction

  Vector3 limited(const Vector3& path) const;
};

struct TouchScene {
  std::string name;  ///< of --scene
  std::string text;  ///< one or two sentences for the panel
  Mesh<Tet4> mesh;
  Scene conditions;
  std::vector<Tissue> tissues;
  std::vector<Composition> compositions;  ///< the first is the one to begin with
  std::vector<Tool> tools;
  std::vector<Vector3> starts;  ///< [m] of every tool
  ServoOptions session{};
  MotionRange range{};  ///< of a tool that grasps
  Camera camera{};
  std::string script;         ///< scripted input, see pointer_script.hpp
  std::string hidden_region;  ///< drawn inside the organ when the answer is revealed; empty: nothing is hidden
  /// Conditions at a time [s], for an organ that moves by itself; empty: they never change.
  std::function<Scene(double time)> conditions_at{};
};

/// What the sliders change.
struct Tuning {
  double stiffness = 1.0;             ///< factor of Young's modulus
  double friction = 0.0;              ///< Coulomb's coefficient
  double coupling = 500.0;            ///< [N/m]
  double radius = 1.0;                ///< factor of the radius of spheres and capsules
  Vector3 gravity = Vector3::Zero();  ///< [m/s^2], in addition to what the mesh contains
  bool error_bars = true;             ///< measure the error of forces at set-up, where the composition can
};

/// Names of all scenes, in the order of the panel.
const std::vector<std::string>& scene_names();
/// Throws SetupError(bad_argument) for an unknown name.
TouchScene make_scene(const std::string& name);
/// The scene of a mesh of the user's: touched and fixed parts are groups, or by default the upper and the lower
/// surface.
TouchScene make_own_scene(const std::string& file, const std::string& fix, const std::string& touch);

std::vector<Tool> tuned_tools(const TouchScene& scene, const Tuning& tuning);
ServoOptions tuned_session(const TouchScene& scene, const Tuning& tuning);
double radius_of(const Tool& tool);  ///< [m]; of a blade a margin

}  // namespace live
