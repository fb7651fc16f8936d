// The reference solution with which every composition is compared.
#pragma once

#include "scene.hpp"

namespace tradeoff {

/// Equilibria of the scene at increasing depths.
struct Reference {
  struct Point {
    double depth = 0.0;
    std::vector<Vector3> force;  ///< on every sphere [N]
  };
  std::vector<Point> curve;                        ///< starts at depth 0
  VectorX displacement_small, displacement_large;  ///< of the nodes of the given mesh [m]
  double volume_small = 0.0, volume_large = 0.0;   ///< of the body [m^3]
  Index nodes = 0;
  double seconds = 0.0;
  double mesh_error_small = 0.0, mesh_error_large = 0.0;  ///< relative force error of a mesh with edges twice as long

  /// Force on a sphere at a depth [N], interpolated between the points of the curve by a power law.
  Vector3 force(std::size_t sphere, double depth) const;
};

/// Neo-Hookean tissue in quadratic tetrahedra, with edges of `edge` radii near the spheres. Solves linear elasticity
/// there with exact contact; the effect of large strain, a factor of the force and a difference of the displacement, is
/// computed on a coarser mesh of linear tetrahedra. Throws SetupError when the body is invalid or the solution does not
/// converge.
Reference make_reference(const PressScene& scene, double edge);

/// Ratio of the force of neo-Hookean tissue to that of linear tissue, over depth [m].
struct Stiffening {
  std::vector<double> depth, ratio;
};
/// Measured with one sphere on the given mesh, at a distance of two radii from the contact point of the scene.
Stiffening measure_stiffening(const PressScene& scene);

}  // namespace tradeoff
