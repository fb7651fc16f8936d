// A linear stiffness as the force of explicit integration.
#pragma once

#include <palpate/concepts/assembler.hpp>
#include <palpate/concepts/integrator.hpp>

#include <utility>

namespace palpate::inline PALPATE_ABI {

/// f = K u for any assembler, of any element.
template <StiffnessOperator K>
class LinearForce {
 public:
  explicit LinearForce(K stiffness) : stiffness_(std::move(stiffness)), product_(stiffness_.size()) {}

  Index size() const noexcept { return stiffness_.size(); }
  void force(const VectorX& u, VectorX& f) const noexcept { stiffness_.apply(u, f); }
  /// u K u / 2
  double energy(const VectorX& u) noexcept {
    stiffness_.apply(u, product_);
    return 0.5 * u.dot(product_);
  }
  /// Any length would do.
  double probe_length() const noexcept { return 1.0; }

 private:
  K stiffness_;
  VectorX product_;
};

}  // namespace palpate::inline PALPATE_ABI
