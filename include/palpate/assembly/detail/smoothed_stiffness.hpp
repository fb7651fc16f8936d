// Elements whose strain is an average over neighbours: stiffness, loads, energy and stress.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/assembly/detail/strain_domains.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/local/strain_displacement.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Pattern of nodes that share a domain: nodes of elements with a common node. O(nodes x neighbours^2), allocates.
template <HasSmoothedStrain E>
BlockPattern smoothed_pattern(const Mesh<E>& mesh, const NodeElements& around) {
  BlockPattern pattern;
  pattern.row_start.push_back(0);
  std::vector<NodeId> middle_of(static_cast<std::size_t>(mesh.node_count()), -1), column_of = middle_of;
  for (NodeId i = 0; i < mesh.node_count(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(pattern.column.size());
    const auto add_around = [&](NodeId middle) {
      if (std::exchange(middle_of[static_cast<std::size_t>(middle)], i) == i) return;
      for (const NodeId e : around.of(middle))
        for (const NodeId j : mesh.elements[static_cast<std::size_t>(e)])
          if (j < i && std::exchange(column_of[static_cast<std::size_t>(j)], i) != i) pattern.column.push_back(j);
    };
    for (const NodeId e : around.of(i))
      for (const NodeId middle : mesh.elements[static_cast<std::size_t>(e)]) add_around(middle);
    std::sort(pattern.column.begin() + begin, pattern.column.end());
    pattern.column.push_back(i);
    pattern.row_start.push_back(static_cast<Index>(pattern.column.size()));
  }
  return pattern;
}

/// Calls add(a, b, block) for the lower half of the stiffness of a domain; a and b index its nodes.
template <class Add>
void for_each_domain_block(const StrainDomain& domain, const Matrix6& d, Add&& add) {
  if (const auto isotropic = lame_constants(d)) {
    for (std::size_t b = 0; b < domain.nodes.size(); ++b)
      for (std::size_t a = b; a < domain.nodes.size(); ++a) {
        Matrix3 block = Matrix3::Zero();
        add_isotropic_block(*isotropic, domain.volume * domain.gradients[a], domain.gradients[b], block.data());
        add(a, b, block);
      }
    return;
  }
  for (std::size_t b = 0; b < domain.nodes.size(); ++b) {
    const StrainBlock stress = stress_block(domain.volume, d, strain_displacement(domain.gradients[b]));
    for (std::size_t a = b; a < domain.nodes.size(); ++a)
      add(a, b, force_block(strain_displacement(domain.gradients[a]), stress));
  }
}

}  // namespace detail

/// Assembles the sum over domains of V B^T D B, for elements with smoothed strain. Throws as StrainDomains.
template <detail::HasSmoothedStrain E>
BlockMatrix assemble_stiffness(const Body<E>& body, const SetupLimits& limits) {
  const detail::NodeElements around(body.mesh);
  BlockMatrix k = detail::make_stiffness(detail::smoothed_pattern(body.mesh, around), limits);
  const detail::StrainDomains<E> domains(body.mesh, around, limits);
  const detail::DomainElasticity elasticity(body, domains);
  for (Index d = 0; d < domains.size(); ++d) {
    if (d % 65536 == 0) limits.advance("assembly", static_cast<double>(d) / static_cast<double>(domains.size()));
    const detail::StrainDomain domain = domains[d];
    detail::for_each_domain_block(domain, elasticity(d, domain),
                                  [&](std::size_t a, std::size_t b, const Matrix3& block) {
                                    k.block(k.pattern().find(domain.nodes[a], domain.nodes[b])) += block;
                                  });
  }
  return k;
}

namespace detail {

/// K x domain by domain, without a matrix: stores the domains. Satisfies StiffnessOperator.
template <HasSmoothedStrain E>
class SmoothedStiffness {
 public:
  SmoothedStiffness() = default;
  /// Throws as assemble_stiffness does.
  SmoothedStiffness(const Body<E>& body, const SetupLimits& limits)
      : nodes_(body.mesh.node_count()),
        domains_(body.mesh, NodeElements(body.mesh), limits),
        elasticity_(body, domains_) {}

  Index size() const noexcept { return 3 * nodes_; }
  std::size_t bytes() const noexcept { return domains_.bytes() + elasticity_.bytes(); }

  /// y = K x. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept {
    y.setZero();
    for (Index d = 0; d < domains_.size(); ++d) {
      const StrainDomain domain = domains_[d];
      domain.add_force(elasticity_(d, domain) * domain.strain(x), y);
    }
  }

  std::vector<Matrix3> diagonal_blocks() const {
    std::vector<Matrix3> diagonal(static_cast<std::size_t>(nodes_), Matrix3::Zero());
    for (Index d = 0; d < domains_.size(); ++d) {
      const StrainDomain domain = domains_[d];
      for (std::size_t a = 0; a < domain.nodes.size(); ++a) {
        const StrainBlock b = strain_displacement(domain.gradients[a]);
        diagonal[static_cast<std::size_t>(domain.nodes[a])] +=
            force_block(b, stress_block(domain.volume, elasticity_(d, domain), b));
      }
    }
    return diagonal;
  }

 private:
  Index nodes_ = 0;
  StrainDomains<E> domains_;
  DomainElasticity elasticity_;
};

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

}  // namespace detail

/// Stored energy [J] for nodal displacements u (3 entries per node [m]).
template <detail::HasSmoothedStrain E>
double strain_energy(const Body<E>& body, const VectorX& u) {
  double energy = 0.0;
  detail::for_each_domain_stress(body, body.initial_strain, u,
                                 [&](const detail::StrainDomain& domain, const Vector6& stress, const Vector6& strain) {
                                   energy += 0.5 * domain.volume * stress.dot(strain);
                                 });
  return energy;
}

namespace detail {

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

}  // namespace detail

}}  // namespace palpate
