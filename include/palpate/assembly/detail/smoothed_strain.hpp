// Loads, energy and stress of elements whose strain is an average over neighbours.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/domain_elasticity.hpp>
#include <palpate/assembly/detail/strain_domains.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/smoothed.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Calls visit(domain, stress, strain) for every domain of a body: the elastic strain under displacements u [m], which
/// is the strain minus the initial strain of the region, and the part of the stress [Pa] that belongs to it.
template <HasSmoothedStrain E, class Visit>
void for_each_domain_stress(const Body<E>& body, const std::vector<Vector6>& initial, const VectorX& u, Visit&& visit) {
  const StrainDomains<E> domains(body.mesh);
  const DomainElasticity elasticity(body, domains);
  for (Index d = 0; d < domains.size(); ++d) {
    const StrainDomain domain = domains[d];
    const Vector6 strain = domain.strain(u) - initial[static_cast<std::size_t>(domain.region)];
    visit(domain, elasticity(d, domain) * strain, strain);
  }
}

/// Load f_0 of initial strains per region, for elements with smoothed strain: 3 entries per node [N].
template <HasSmoothedStrain E>
VectorX initial_strain_load(const Body<E>& body, const std::vector<Vector6>& strains) {
  const VectorX none = VectorX::Zero(3 * body.mesh.node_count());
  VectorX f = none;
  for_each_domain_stress(body, strains, none, [&](const StrainDomain& domain, const Vector6& stress, const Vector6&) {
    domain.add_force(-stress, f);
  });
  return f;
}

/// Stored energy [J] for nodal displacements u (3 entries per node [m]).
template <HasSmoothedStrain E>
double strain_energy(const Body<E>& body, const VectorX& u) {
  double energy = 0.0;
  for_each_domain_stress(body, body.initial_strain, u,
                         [&](const StrainDomain& domain, const Vector6& stress, const Vector6& strain) {
                           energy += 0.5 * domain.volume * stress.dot(strain);
                         });
  return energy;
}

/// Strain, and stress [Pa], of every element, one per column: means over its edges and nodes. With this stress an
/// element contributes the same nodal forces B^T sigma V as in K.
struct SmoothedState {
  Eigen::Matrix<double, 6, Eigen::Dynamic> strain, stress;
};

template <HasSmoothedStrain E>
SmoothedState smoothed_state(const Body<E>& body, const VectorX& u) {
  SmoothedState state;
  state.strain.setZero(6, body.mesh.element_count());
  state.stress.setZero(6, body.mesh.element_count());
  const auto visit = [&](const StrainDomain& domain, const Vector6& stress, const Vector6& elastic) {
    const Vector6 strain = elastic + body.initial_strain[static_cast<std::size_t>(domain.region)];
    Vector6 part = Vector6::Zero();
    for (int i = 0; i < 3; ++i) part[i] = (strain[0] + strain[1] + strain[2]) / 3.0;
    if (domain.part == StrainPart::deviatoric) part = strain - part;
    const double share = domain.part == StrainPart::deviatoric ? 1.0 / 6.0 : 1.0 / 4.0;
    for (const NodeId e : domain.elements)
      for (int i = 0; i < 6; ++i) {
        state.strain.coeffRef(i, e) += share * part[i];
        state.stress.coeffRef(i, e) += share * stress[i];
      }
  };
  for_each_domain_stress(body, body.initial_strain, u, visit);
  return state;
}

}}  // namespace palpate
