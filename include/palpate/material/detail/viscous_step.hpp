// A viscoelastic material over one step, which is hyperelastic.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/detail/material_range.hpp>

#include <Eigen/LU>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// The stress of a material under a pure change of volume: U(J) = W(J^(1/3) I), for J > 0.
template <class Base>
class VolumeStress {
 public:
  VolumeStress(const Base& base, const Tensor3<double>& f) noexcept
      : base_(base), cofactor_(cofactor(f)), side_(std::cbrt(determinant(f, cofactor_))) {
    pressure_ = trace(base.stress(sphere())) / (3.0 * side_ * side_);
  }

  double energy() const noexcept { return base_.energy(sphere()); }
  /// dU/dF = U' cof F [Pa]
  Tensor3<double> stress() const noexcept { return pressure_ * cofactor_; }
  /// d2U/dF2
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    const auto unit = vector9(Tensor3<double>::identity());
    const double along =
        unit.dot(base_.tangent(sphere()) * unit) / (3.0 * side_ * side_);  // d(3 s^2 U')/ds and its share
    const double second = (along - 2.0 * pressure_ / side_) / (3.0 * side_ * side_);
    const auto column = vector9(cofactor_);
    Matrix9 t = pressure_ * cofactor_derivative(f);
    t += (second * column) * column.transpose();
    return t;
  }

 private:
  Tensor3<double> sphere() const noexcept { return Tensor3<double>::diagonal(side_, side_, side_); }

  const Base& base_;
  Tensor3<double> cofactor_;
  double side_, pressure_ = 0.0;
};

}  // namespace detail

/// The incremental potential of a Prony series over a step (Ortiz and Stainier 1999), after relaxation over the step:
///   W = share W0(F) + kept U(J) + driving : E,   E = (F^T F - I)/2,
/// where `driving` is the remaining second Piola-Kirchhoff stress of the history and U the part of W0 from a change of
/// volume. It exists for every base, so a viscoelastic step is minimised like an elastic one. Needs J > 0. Refers to
/// the base.
template <class Base>
struct ViscousStep {
  const Base& base;
  double share, kept;
  Tensor3<double> driving;

  double energy(const Tensor3<double>& f) const noexcept {
    const Tensor3<double> h = detail::from_rest(f);
    double w = share * base.energy(f) + contract(driving, h) + 0.5 * contract(h * driving, h);
    if (kept != 0.0) w += kept * detail::VolumeStress<Base>(base, f).energy();
    return w;
  }
  Tensor3<double> stress(const Tensor3<double>& f) const noexcept {
    Tensor3<double> p = share * base.stress(f) + f * driving;
    if (kept != 0.0) p = p + kept * detail::VolumeStress<Base>(base, f).stress();
    return p;
  }
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    Matrix9 t = share * base.tangent(f);
    detail::add_right_product(t, 1.0, driving);
    if (kept != 0.0) t += kept * detail::VolumeStress<Base>(base, f).tangent(f);
    return t;
  }
  bool admits(const Tensor3<double>& f) const noexcept { return base.admits(f) && determinant(f) > 0.0; }
  /// That of the base: relaxation scales its stress.
  bool is_beyond_range(const Tensor3<double>& f) const noexcept { return detail::is_beyond_range(base, f); }
};

}}  // namespace palpate
