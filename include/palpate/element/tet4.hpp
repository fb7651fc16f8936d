// The four-node tetrahedron and its face, the three-node triangle.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>
#include <palpate/quadrature/simplex.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Linear triangle on the unit triangle (0, e1, e2): N = (1 - u - v, u, v).
struct Tri3 {
  static constexpr int nodes = 3;
  static constexpr std::array<std::array<int, 3>, 1> triangles{{{0, 1, 2}}};
  using Quadrature = TriangleRule<2>;

  static Eigen::Vector3d shape(const Eigen::Vector2d& xi) noexcept { return {1.0 - xi[0] - xi[1], xi[0], xi[1]}; }

  static Eigen::Matrix<double, 3, 2> gradient(const Eigen::Vector2d&) noexcept {
    return detail::matrix_of_rows<3, 2>({{-1, -1}, {1, 0}, {0, 1}});
  }

  static Eigen::Matrix<double, 3, 2> reference_nodes() noexcept {
    return detail::matrix_of_rows<3, 2>({{0, 0}, {1, 0}, {0, 1}});
  }
};

static_assert(TriangulatedFace<Tri3>);

/// Linear tetrahedron on the unit tetrahedron (0, e1, e2, e3): N = (1 - u - v - w, u, v, w). The thesis (3.3.2) uses a
/// regular reference tetrahedron instead; the element is the same, its printed shape functions are corrected in
/// docs/thesis.md. Locks near incompressibility: results above `locking_poisson_ratio` are flagged.
struct Tet4 {
  static constexpr int nodes = 4;
  static constexpr int order = 1;
  static constexpr double reference_volume = 1.0 / 6.0;
  static constexpr double locking_poisson_ratio = 0.4;
  static constexpr std::array<std::array<int, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  using Face = Tri3;
  using Quadrature = TetrahedronRule<1>;
  using MassQuadrature = TetrahedronRule<2>;

  static Eigen::Vector4d shape(const Vector3& xi) noexcept {
    return {1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
  }

  static Eigen::Matrix<double, 4, 3> gradient(const Vector3&) noexcept {
    return detail::matrix_of_rows<4, 3>({{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  }

  static Eigen::Matrix<double, 4, 3> reference_nodes() noexcept {
    return detail::matrix_of_rows<4, 3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  }
};

static_assert(Element<Tet4>);

}}  // namespace palpate
