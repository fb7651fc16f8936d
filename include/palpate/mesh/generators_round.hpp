// Spheres and cylinders of tetrahedra.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Sphere around the origin [m]: `refinement` = n layers between centre and surface, 20 n^3 elements, 10 n^2 + 2 nodes
/// on the surface, the others inside (n = 1: the centre). Least quality above 0.6 for any n. Group "surface" contains
/// all boundary nodes and outward faces. Refuses sizes that are not positive as bad_argument, n > 400 as
/// count_too_large.
Mesh<Tet4> sphere_tet4(double radius, int refinement);

/// Cylinder around the z axis from z = 0 to `height` [m]: `n` rings between axis and side, with a number of layers that
/// makes the elements about as high as wide; 18 n^2 elements per layer. Groups "bottom", "top" and "side" contain nodes
/// and outward faces. Refuses sizes that are not positive as bad_argument, more than 10^8 elements as count_too_large.
Mesh<Tet4> cylinder_tet4(double radius, double height, int n);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/generators_round.ipp>
#endif
