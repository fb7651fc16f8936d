// Transversely isotropic linear elasticity: one direction of fibres.
#pragma once

#include <palpate/material/orthotropic.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI {

/// Hooke's law with five constants: stiffer (or softer) along the fibres, the same in all directions across them;
/// muscle, tendon. Where the mesh has a fibre direction per element (`Mesh::fibres`) that counts, elsewhere `fibre`.
/// Admissible: moduli positive, the compliance positive definite, `fibre` a unit vector to within 1e-5.
struct TransverselyIsotropic {
  double youngs_modulus_along = 0.0;   ///< E under a pull along the fibres [Pa]
  double youngs_modulus_across = 0.0;  ///< E under a pull across them [Pa]
  double poisson_ratio_along = 0.0;    ///< contraction across the fibres per extension along them [-]
  double poisson_ratio_across = 0.0;   ///< contraction across per extension across [-]
  double shear_modulus_along = 0.0;    ///< G of shear in planes that hold the fibres [Pa]
  Vector3 fibre = Vector3::UnitX();    ///< unit vector
  double density = 0.0;                ///< rho [kg/m^3]

  /// G of shear in the plane across the fibres [Pa], which isotropy there gives.
  double shear_modulus_across() const noexcept { return youngs_modulus_across / (2.0 * (1.0 + poisson_ratio_across)); }

  /// The elasticity matrix [Pa], 6 x 6, engineering shear, with the fibres along this vector of unit length.
  Matrix6 elasticity(const Vector3& along) const noexcept { return orthotropic(along).elasticity(); }
  Matrix6 elasticity() const noexcept { return elasticity(fibre); }

  /// The problem with these parameters, or nothing.
  std::optional<SetupProblem> check() const {
    if (const double length = fibre.norm(); !(std::abs(length - 1.0) <= 1e-5))
      return parameter_problem(SetupErrorKind::bad_argument, "the length of the fibre direction", length, 1.0,
                               "Give a unit vector");
    auto problem = orthotropic(fibre).check();
    if (problem) problem->what += " (orthotropic axis 1 is the fibre)";
    return problem;
  }

 private:
  /// The same law by nine constants: axis 1 along the fibre, the two others anyhow.
  Orthotropic orthotropic(const Vector3& along) const noexcept {
    Orthotropic o;
    o.youngs_modulus_1 = youngs_modulus_along;
    o.youngs_modulus_2 = o.youngs_modulus_3 = youngs_modulus_across;
    o.poisson_ratio_12 = o.poisson_ratio_13 = poisson_ratio_along;
    o.poisson_ratio_23 = poisson_ratio_across;
    o.shear_modulus_12 = o.shear_modulus_13 = shear_modulus_along;
    o.shear_modulus_23 = shear_modulus_across();
    o.density = density;
    Eigen::Index least = 0;
    along.cwiseAbs().minCoeff(&least);
    o.axes.col(0) = along.normalized();
    o.axes.col(1) = along.cross(Vector3::Unit(least)).normalized();
    o.axes.col(2) = o.axes.col(0).cross(o.axes.col(1));
    return o;
  }
};

static_assert(FibreMaterial<TransverselyIsotropic>);

}}  // namespace palpate
