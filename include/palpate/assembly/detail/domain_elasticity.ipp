// Definitions of domain_elasticity.hpp.
#pragma once

#include <palpate/assembly/detail/domain_elasticity.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE const Matrix6& DomainElasticity::operator()(Index d, const StrainDomain& domain) const noexcept {
  return elasticity_[by_domain_ ? static_cast<std::size_t>(d)
                                : place(static_cast<std::size_t>(domain.region), domain.part)];
}

PALPATE_INLINE std::size_t DomainElasticity::place(std::size_t material, StrainPart part) noexcept {
  return 2 * material + (part == StrainPart::volumetric ? 1 : 0);
}

}}  // namespace palpate
