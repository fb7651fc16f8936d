// The ten-node tetrahedron.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/tri6.hpp>
#include <palpate/quadrature/tetrahedron.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Quadratic tetrahedron on the unit tetrahedron, L = (1 - u - v - w, u, v, w): corners L (2 L - 1), then 4 L_i L_j on
/// the `edges`, in the order of VTK and CalculiX (Gmsh swaps the last two). Usable to a Poisson ratio of 0.499. Its
/// edges may be curved. Four points integrate the stiffness, exactly if the edges are straight. With curved edges a
/// constant strain is represented only up to an error from the curvature, which matters near incompressibility (2 % of
/// the displacement at 0.499 on a coarsely meshed thick sphere): use `WithQuadrature<Tet10, TetrahedronRule<5>>` there.
struct Tet10 {
  static constexpr int nodes = 10;
  static constexpr int order = 2;
  static constexpr double reference_volume = 1.0 / 6.0;
  static constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  static constexpr std::array<std::array<int, 6>, 4> faces{
      {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}}};
  using Linear = Tet4;
  using Face = Tri6;
  using Quadrature = TetrahedronRule<2>;
  using MassQuadrature = TetrahedronRule<5>;

  static Eigen::Matrix<double, 10, 1> shape(const Vector3& xi) noexcept;

  static Eigen::Matrix<double, 10, 3> gradient(const Vector3& xi) noexcept;

  static Eigen::Matrix<double, 10, 3> reference_nodes() noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/element/tet10.ipp>
#endif
