// Definitions of strain_domains.hpp.
#pragma once

#include <palpate/assembly/strain_domains.hpp>
#include <palpate/core/voigt.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Vector6 StrainDomain::strain(const VectorX& u) const noexcept {
  Matrix3 h = Matrix3::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a)
    h.noalias() += u.segment<3>(3 * Index{nodes[a]}) * gradients[a].transpose();
  return voigt::strain_vector(Matrix3(0.5 * (h + h.transpose())));
}

PALPATE_INLINE void StrainDomain::add_force(const Vector6& stress, VectorX& f) const noexcept {
  const Matrix3 tensor = volume * voigt::stress_tensor(stress);
  for (std::size_t a = 0; a < nodes.size(); ++a) f.segment<3>(3 * Index{nodes[a]}).noalias() += tensor * gradients[a];
}

}}  // namespace palpate
