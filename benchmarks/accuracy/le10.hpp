// NAFEMS LE10: an elliptic thick plate under pressure.
#pragma once

#include "meshes.hpp"
#include "statics.hpp"

#include <palpate/post/patch_recovery.hpp>

namespace accuracy {

/// Target of the benchmark (NAFEMS, The Standard NAFEMS Benchmarks, 1990): sigma_yy at D = (2, 0, 0.6) m [Pa].
inline constexpr double le10_target = -5.38e6;

/// Symmetry planes; the rim is constrained in x and y, its midline also in z; 1 MPa on top.
inline Scene le10_scene() {
  return Scene()
      .prescribe("x0", {0.0, std::nullopt, std::nullopt})
      .prescribe("x1", {std::nullopt, 0.0, std::nullopt})
      .prescribe("y1", {0.0, 0.0, std::nullopt})
      .prescribe("rim_midline", {std::nullopt, std::nullopt, 0.0})
      .pressure("z1", 1e6);
}

inline constexpr LinearElastic le10_steel{.youngs_modulus = 210e9, .poisson_ratio = 0.3};

/// Recovered sigma_yy at D [Pa] for a displacement of the plate.
template <Element E>
double le10_stress(const Body<E>& body, const VectorX& displacement) {
  return patch_recovery(body, displacement).at(nearest_node(body.mesh, {2.0, 0.0, 0.6}))[voigt::yy];
}

}  // namespace accuracy
