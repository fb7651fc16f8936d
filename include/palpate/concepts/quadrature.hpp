// Concept of a quadrature rule.
#pragma once

#include <palpate/core/config.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// One point of a rule: reference coordinates and weight.
template <int Dimension>
struct QuadraturePoint {
  std::array<double, Dimension> xi;
  double weight;
};

/// A fixed rule on a reference domain. `points` is a constexpr array; weights sum to the reference volume and every
/// polynomial up to `degree` is integrated exactly (testing/quadrature_laws.hpp).
template <class Q>
concept Quadrature = requires {
  requires std::integral<std::remove_cvref_t<decltype(Q::dimension)>>;
  requires std::integral<std::remove_cvref_t<decltype(Q::degree)>>;
  requires std::same_as<std::remove_cvref_t<decltype(Q::points)>,
                        std::array<QuadraturePoint<Q::dimension>, Q::points.size()>>;
};

}}  // namespace palpate
