// Stiffness of one element.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/integration_points.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Stiffness matrix of an element, node-major (x y z per node).
template <Element E>
using ElementStiffness = Eigen::Matrix<double, 3 * E::nodes, 3 * E::nodes>;

/// K_e = sum_q B^T D B dV [N/m] (thesis 3.41) with the element's own rule. `x`: coordinates of the nodes [m], one node
/// per row; `d`: elasticity matrix [Pa].
template <Element E>
ElementStiffness<E> element_stiffness(const ElementNodes<E>& x, const Matrix6& d) noexcept {
  ElementStiffness<E> k = ElementStiffness<E>::Zero();
  for (const IntegrationPoint<E>& point : integration_points<E>(x)) {
    Eigen::Matrix<double, 6, 3 * E::nodes> b;
    for (int a = 0; a < E::nodes; ++a) {
      const StrainBlock block = strain_block<E>(point, a);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 6; ++i) b.coeffRef(i, 3 * a + j) = block.coeff(i, j);
    }
    k.noalias() += b.transpose() * (point.volume * d) * b;
  }
  return k;
}

}}}  // namespace palpate::detail
