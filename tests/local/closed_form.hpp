#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

/// The linear tetrahedron by cross products, in any precision; independent of the formulas of the library.
namespace test {

using namespace palpate;

template <class Real>
using Tet4Nodes = Eigen::Matrix<Real, 4, 3>;
template <class Real>
using DenseMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
template <class Real>
using DenseVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Volume and gradients of the four shape functions, one per row: g_1 = (e_2 x e_3) / 6V and so on.
template <class Real>
Real closed_form_gradients(const Tet4Nodes<Real>& x, Tet4Nodes<Real>& g) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  std::array<Vector, 3> e;
  for (int i = 0; i < 3; ++i) e[static_cast<std::size_t>(i)] = (x.row(i + 1) - x.row(0)).transpose();
  const Real six_volumes = e[0].dot(e[1].cross(e[2]));
  g.row(1) = e[1].cross(e[2]).transpose() / six_volumes;
  g.row(2) = e[2].cross(e[0]).transpose() / six_volumes;
  g.row(3) = e[0].cross(e[1]).transpose() / six_volumes;
  g.row(0) = -(g.row(1) + g.row(2) + g.row(3));
  return six_volumes / 6;
}

/// K_ab = V (lambda g_a g_b^T + mu g_b g_a^T + mu g_a . g_b I).
template <class Real>
Eigen::Matrix<Real, 12, 12> closed_form_stiffness(const Tet4Nodes<Real>& x, const LinearElastic& m) {
  const Real young = static_cast<Real>(m.youngs_modulus), nu = static_cast<Real>(m.poisson_ratio);
  const Real lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), mu = young / (2 * (1 + nu));
  Tet4Nodes<Real> g;
  const Real volume = closed_form_gradients(x, g);
  Eigen::Matrix<Real, 12, 12> k;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      const Eigen::Matrix<Real, 3, 3> outer = g.row(a).transpose() * g.row(b);
      Eigen::Matrix<Real, 3, 3> block = lambda * outer + mu * outer.transpose();
      block.diagonal().array() += mu * outer.trace();
      k.template block<3, 3>(3 * a, 3 * b) = volume * block;
    }
  return k;
}

/// Stiffness of a whole mesh, materials per region, no boundary conditions.
template <class Real>
DenseMatrix<Real> closed_form_stiffness(const Mesh<Tet4>& mesh, const std::vector<LinearElastic>& by_region) {
  const Index n = 3 * mesh.node_count();
  DenseMatrix<Real> k = DenseMatrix<Real>::Zero(n, n);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const Tet4Nodes<Real> x = element_nodes<Tet4>(mesh, e).cast<Real>();
    const auto ke = closed_form_stiffness<Real>(x, by_region[static_cast<std::size_t>(mesh.region(e))]);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        k.template block<3, 3>(3 * Index{mesh.element_node(e, a)}, 3 * Index{mesh.element_node(e, b)}) +=
            ke.template block<3, 3>(3 * a, 3 * b);
  }
  return k;
}

/// A random tetrahedron of size one, not flat, positively oriented.
inline ElementNodes<Tet4> random_tetrahedron(testing::Random& random) {
  ElementNodes<Tet4> x, g;
  do {
    for (int a = 0; a < 4; ++a) x.row(a) = random.vector<3>(-1.0, 1.0).transpose();
  } while (closed_form_gradients<double>(x, g) < 0.1);
  return x;
}

/// An orthotropic elasticity matrix with nine different numbers (not from measured constants).
inline Matrix6 orthotropic() {
  Matrix6 d = Matrix6::Zero();
  d.topLeftCorner<3, 3>() << 11, 3, 2, 3, 13, 4, 2, 4, 17;
  d.diagonal().tail<3>() << 5, 6, 7;
  return 1e3 * d;
}

/// Largest entry.
template <class Derived>
double largest(const Eigen::MatrixBase<Derived>& m) {
  return static_cast<double>(m.cwiseAbs().maxCoeff());
}

/// The reference nodes under a random affine map without reflection: straight sides, any shape.
template <Element E>
ElementNodes<E> some_element(testing::Random& random) {
  const ElementNodes<Tet4> image = random_tetrahedron(random);
  Matrix3 axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = (image.row(i + 1) - image.row(0)).transpose();
  return (E::reference_nodes() * axes.transpose()).rowwise() + image.row(0);
}

}  // namespace test
