// Definitions of strain_domains.hpp.
#pragma once

#include <palpate/assembly/detail/strain_domains.hpp>
#include <palpate/core/voigt.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Vector6 StrainDomain::strain(const VectorX& u) const noexcept {
  Vector6 e = Vector6::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const double* const ua = u.data() + 3 * Index{nodes[a]};
    const Vector3& g = gradients[a];
    e[voigt::xx] += ua[0] * g[0];
    e[voigt::yy] += ua[1] * g[1];
    e[voigt::zz] += ua[2] * g[2];
    e[voigt::xy] += ua[0] * g[1] + ua[1] * g[0];
    e[voigt::xz] += ua[0] * g[2] + ua[2] * g[0];
    e[voigt::yz] += ua[1] * g[2] + ua[2] * g[1];
  }
  return e;
}

PALPATE_INLINE void StrainDomain::add_force(const Vector6& stress, VectorX& f) const noexcept {
  const Matrix3 tensor = volume * voigt::stress_tensor(stress);
  for (std::size_t a = 0; a < nodes.size(); ++a) add_node_vector(f, nodes[a], tensor * gradients[a]);
}

}}  // namespace palpate
