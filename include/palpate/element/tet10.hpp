// The ten-node tetrahedron and its face, the six-node triangle.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/quadrature/simplex.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Quadratic triangle on the unit triangle, L = (1 - u - v, u, v): corners L (2 L - 1), then 4 L_i L_j on the edges.
struct Tri6 {
  static constexpr int nodes = 6;
  static constexpr std::array<std::array<int, 2>, 3> edges{{{0, 1}, {1, 2}, {2, 0}}};  ///< of nodes 3, 4, 5
  static constexpr std::array<std::array<int, 3>, 4> triangles{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  using Quadrature = TriangleRule<4>;

  static Eigen::Matrix<double, 6, 1> shape(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 6, 2> gradient(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 6, 2> reference_nodes() noexcept {
    return detail::matrix_of_rows<6, 2>({{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}});
  }
};

static_assert(TriangulatedFace<Tri6>);

inline Eigen::Matrix<double, 6, 1> Tri6::shape(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  Eigen::Matrix<double, 6, 1> n;
  for (int a = 0; a < 3; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    n[a] = l[a] * (2.0 * l[a] - 1.0);
    n[3 + a] = 4.0 * l[i] * l[j];
  }
  return n;
}

inline Eigen::Matrix<double, 6, 2> Tri6::gradient(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  const Eigen::Matrix<double, 3, 2> d = Tri3::gradient(xi);
  Eigen::Matrix<double, 6, 2> g;
  for (int a = 0; a < 3; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    for (int k = 0; k < 2; ++k) {
      g.coeffRef(a, k) = (4.0 * l[a] - 1.0) * d.coeff(a, k);
      g.coeffRef(3 + a, k) = 4.0 * (l[i] * d.coeff(j, k) + l[j] * d.coeff(i, k));
    }
  }
  return g;
}

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

static_assert(Element<Tet10>);

inline Eigen::Matrix<double, 10, 1> Tet10::shape(const Vector3& xi) noexcept {
  const Eigen::Vector4d l = Tet4::shape(xi);
  Eigen::Matrix<double, 10, 1> n;
  for (int a = 0; a < 4; ++a) n[a] = l[a] * (2.0 * l[a] - 1.0);
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    n[4 + a] = 4.0 * l[i] * l[j];
  }
  return n;
}

inline Eigen::Matrix<double, 10, 3> Tet10::gradient(const Vector3& xi) noexcept {
  const Eigen::Vector4d l = Tet4::shape(xi);
  const Eigen::Matrix<double, 4, 3> d = Tet4::gradient(xi);
  Eigen::Matrix<double, 10, 3> g;
  for (int a = 0; a < 4; ++a)
    for (int k = 0; k < 3; ++k) g.coeffRef(a, k) = (4.0 * l[a] - 1.0) * d.coeff(a, k);
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    for (int k = 0; k < 3; ++k) g.coeffRef(4 + a, k) = 4.0 * (l[i] * d.coeff(j, k) + l[j] * d.coeff(i, k));
  }
  return g;
}

inline Eigen::Matrix<double, 10, 3> Tet10::reference_nodes() noexcept {
  return detail::matrix_of_rows<10, 3>({{0, 0, 0},
                                        {1, 0, 0},
                                        {0, 1, 0},
                                        {0, 0, 1},
                                        {0.5, 0, 0},
                                        {0.5, 0.5, 0},
                                        {0, 0.5, 0},
                                        {0, 0, 0.5},
                                        {0.5, 0, 0.5},
                                        {0, 0.5, 0.5}});
}

}}  // namespace palpate
