// Gradients and volume of elements with constant gradients.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Elements with one integration point, so constant gradients (Tet4).
template <class E>
concept ConstantGradient = Element<E> && E::Quadrature::points.size() == 1;

/// Geometry of element e [1/m, m^3]. Throws inverted_element for a negative volume, non_finite for a volume that is
/// zero or NaN.
template <ConstantGradient E>
PointGeometry<E> constant_geometry(const Mesh<E>& mesh, Index e) {
  constexpr auto point = E::Quadrature::points[0];
  const PointGeometry<E> g = point_geometry<E>(element_nodes<E>(mesh, e), reference_point(point), point.weight);
  if (g.volume < 0.0) raise_element(SetupErrorKind::inverted_element, e, "has a negative volume");
  if (!(g.volume > 0.0) || !all_finite(g.gradient))
    raise_element(SetupErrorKind::non_finite, e, "has a stiffness that is not finite");
  return g;
}

}}  // namespace palpate
