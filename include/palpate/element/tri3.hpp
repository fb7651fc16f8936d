// The three-node triangle: the face of Tet4.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>
#include <palpate/quadrature/triangle.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Linear triangle on the unit triangle (0, e1, e2): N = (1 - u - v, u, v).
struct Tri3 {
  static constexpr int nodes = 3;
  static constexpr std::array<std::array<int, 3>, 1> triangles{{{0, 1, 2}}};
  using Quadrature = TriangleRule<2>;

  static Eigen::Vector3d shape(const Eigen::Vector2d& xi) noexcept { return {1.0 - xi[0] - xi[1], xi[0], xi[1]}; }

  static Eigen::Matrix<double, 3, 2> gradient(const Eigen::Vector2d&) noexcept;

  static Eigen::Matrix<double, 3, 2> reference_nodes() noexcept;
};

static_assert(TriangulatedFace<Tri3>);

inline Eigen::Matrix<double, 3, 2> Tri3::gradient(const Eigen::Vector2d&) noexcept {
  return detail::matrix_of_rows<3, 2>({{-1, -1}, {1, 0}, {0, 1}});
}

inline Eigen::Matrix<double, 3, 2> Tri3::reference_nodes() noexcept {
  return detail::matrix_of_rows<3, 2>({{0, 0}, {1, 0}, {0, 1}});
}

}}  // namespace palpate
