// What every composition is measured against.
#pragma once

#include "scene.hpp"

namespace tradeoff {

/// Equilibria of the scene at rising depths.
struct Reference {
  struct Point {
    double depth = 0.0;
    std::vector<Vector3> force;  ///< on every sphere [N]
  };
  std::vector<Point> curve;                        ///< from depth 0 on
  VectorX displacement_small, displacement_large;  ///< of the nodes of the mesh as given [m]
  double volume_small = 0.0, volume_large = 0.0;   ///< of the body [m^3]
  Index nodes = 0;
  double seconds = 0.0;
  double mesh_error_small = 0.0, mesh_error_large = 0.0;  ///< how far a mesh with edges twice as long is, of the force

  /// Of sphere b at a depth, between the points of the curve by a power law.
  Vector3 force(std::size_t sphere, double depth) const;
};

/// Neo-Hookean tissue in quadratic tetrahedra, `edge` radii long where the spheres press: linear there, with exact
/// contact, times what large strain changes of the force (and plus what it changes of the displacement) on a mesh of
/// linear tetrahedra, where that is cheap. Throws SetupError where the body or the answer is not as it must be.
Reference make_reference(const PressScene& scene, double edge);

/// How many times the force of linear tissue the neo-Hookean one takes, by depth [m].
struct Stiffening {
  std::vector<double> depth, ratio;
};
/// Measured with one sphere on the mesh as given, two radii beside the place where the scene presses.
Stiffening measure_stiffening(const PressScene& scene);

}  // namespace tradeoff
