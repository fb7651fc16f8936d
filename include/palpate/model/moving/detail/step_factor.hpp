// The approximate inverse that a quasi-Newton method starts from.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// An approximate inverse of K + m M, symmetric and positive definite, for a stiffness K and a mass M. Vectors have 3
/// entries per node. Used by one thread; neither allocates nor throws.
class StepFactor {
 public:
  StepFactor() = default;
  StepFactor(const StepFactor&) = delete;
  StepFactor& operator=(const StepFactor&) = delete;
  virtual ~StepFactor() = default;

  /// Sets m [1/s^2]; factorises when it is new. Returns false without a factor.
  virtual bool set_mass(double mass) noexcept = 0;
  /// Adapts the inverse to the displacement u [m]: by the rotations of nodes, or by their deformation gradients.
  virtual void rotate(const VectorX& u, bool stretched = false) noexcept = 0;
  /// z = inverse times r. On constrained dofs r is zero, and z is not read.
  virtual void solve(const VectorX& r, VectorX& z) noexcept = 0;

  /// y = the matrix times x, which may differ from zero on constrained dofs.
  virtual void apply(const VectorX& x, VectorX& y) noexcept = 0;
  /// Whether some parts are much stiffer than others. Then the norm of forces does not show whether all are in
  /// equilibrium.
  virtual bool is_uneven() const noexcept = 0;

  /// Asks for a factor at displacement u [m] from another thread, if there is one and it is idle.
  virtual void ask(const VectorX&) noexcept {}
  /// Takes the factor from that thread if it is ready.
  virtual void take_renewed() noexcept {}
  /// Number of factors taken so far.
  virtual long renewals() const noexcept { return 0; }
};

}}}  // namespace palpate::detail
