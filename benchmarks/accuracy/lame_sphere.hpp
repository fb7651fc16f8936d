// A hollow sphere under internal pressure: Lame's solution.
#pragma once

#include "meshes.hpp"
#include "statics.hpp"

namespace accuracy {

/// Inner radius a, outer radius b [m], internal pressure p [Pa].
struct LameSphere {
  double a = 1.0, b = 2.0, p = 1.0;
  LinearElastic material{.youngs_modulus = 1000.0, .poisson_ratio = 0.3};

  double factor() const { return p * a * a * a / (b * b * b - a * a * a); }
  double radial_displacement(double r) const {
    const double nu = material.poisson_ratio;
    return factor() / material.youngs_modulus * ((1.0 - 2.0 * nu) * r + (1.0 + nu) * b * b * b / (2.0 * r * r));
  }
  Vector3 displacement(const Vector3& x) const { return radial_displacement(x.norm()) * x.normalized(); }
  Vector6 stress(const Vector3& x) const {
    const double cube = std::pow(b / x.norm(), 3), radial = factor() * (1.0 - cube),
                 hoop = factor() * (1.0 + 0.5 * cube);
    const Vector3 n = x.normalized();
    return voigt::stress_vector(hoop * Matrix3::Identity() + (radial - hoop) * n * n.transpose());
  }
  Scene scene() const {
    return Scene()
        .prescribe("x0", {0.0, std::nullopt, std::nullopt})
        .prescribe("y0", {std::nullopt, 0.0, std::nullopt})
        .prescribe("z0", {std::nullopt, std::nullopt, 0.0})
        .pressure("inner", p);
  }
};

}  // namespace accuracy
