// The eight-node hexahedron.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/quad4.hpp>
#include <palpate/quadrature/tensor.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Trilinear hexahedron on [-1, 1]^3: bottom (w = -1) counter-clockwise seen from above, then top; 2 x 2 x 2 points.
/// The standard, fully integrated brick. It locks near incompressibility, and results above `locking_poisson_ratio` are
/// flagged.
struct Hex8 {
  static constexpr int nodes = 8;
  static constexpr int order = 1;
  static constexpr double reference_volume = 8.0;
  static constexpr double locking_poisson_ratio = 0.4;  // at 0.45 up to 18 % too stiff in bending
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  using Face = Quad4;
  using Quadrature = HexahedronRule<2>;
  using MassQuadrature = HexahedronRule<2>;

  static Eigen::Matrix<double, 8, 1> shape(const Vector3& xi) noexcept;

  static Eigen::Matrix<double, 8, 3> gradient(const Vector3& xi) noexcept;

  static Eigen::Matrix<double, 8, 3> reference_nodes() noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/element/hex8.ipp>
#endif
