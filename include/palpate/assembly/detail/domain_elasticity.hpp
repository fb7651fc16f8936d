// The elasticity of the domains over which a smoothed strain is averaged.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/constant_geometry.hpp>
#include <palpate/assembly/detail/strain_domains.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/local/detail/split_elasticity.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The part of the elasticity [Pa] that acts in each domain of a body. If the elasticity differs between elements
/// (along fibres), the volume-weighted mean over the domain: 288 bytes per domain.
class DomainElasticity {
 public:
  DomainElasticity() = default;

  template <HasSmoothedStrain E>
  DomainElasticity(const Body<E>& body, const StrainDomains<E>& domains) : by_domain_(!body.materials.empty()) {
    std::vector<Matrix6> materials;  // both parts of each matrix
    for (const Matrix6& d : body.elasticity) {
      const SplitElasticity split = split_elasticity(d);
      materials.push_back(split.deviatoric);
      materials.push_back(split.volumetric);
    }
    if (!by_domain_) {
      elasticity_ = std::move(materials);
      return;
    }
    for (Index d = 0; d < domains.size(); ++d) {
      const StrainDomain domain = domains[d];
      Matrix6 sum = Matrix6::Zero();
      double volume = 0.0;
      for (const NodeId e : domain.elements) {
        const double v = constant_geometry(body.mesh, Index{e}).volume;
        sum += v * materials[place(body.material_of(e), domain.part)];
        volume += v;
      }
      elasticity_.push_back(sum / volume);
    }
  }

  std::size_t bytes() const noexcept { return elasticity_.size() * sizeof(Matrix6); }
  /// Elasticity of domain number d.
  const Matrix6& operator()(Index d, const StrainDomain& domain) const noexcept;

 private:
  static std::size_t place(std::size_t material, StrainPart part) noexcept;

  bool by_domain_ = false;
  std::vector<Matrix6> elasticity_;  // of every domain, or both parts of every region
};

inline const Matrix6& DomainElasticity::operator()(Index d, const StrainDomain& domain) const noexcept {
  return elasticity_[by_domain_ ? static_cast<std::size_t>(d)
                                : place(static_cast<std::size_t>(domain.region), domain.part)];
}

inline std::size_t DomainElasticity::place(std::size_t material, StrainPart part) noexcept {
  return 2 * material + (part == StrainPart::volumetric ? 1 : 0);
}

}}  // namespace palpate
