#pragma once

#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include "assembly/bodies.hpp"
#include "local/closed_form.hpp"

#include <numbers>

/// Tests common to all elements. Each element is compiled in a separate file.
namespace test {

template <Element E>
using StaticModel = HapticFEModel<E, LinearElastic, SparseCholesky>;

template <Element E>
Mesh<E> box_of(const Vector3& size, std::array<int, 3> cells) {
  if constexpr (E::nodes == 4)
    return copy_mesh<E>(box_tet4(size, cells));
  else if constexpr (E::nodes == 8)
    return copy_mesh<E>(box_hex8(size, cells));
  else if constexpr (E::nodes == 10)
    return copy_mesh<E>(box_tet10(size, cells));
  else
    return copy_mesh<E>(box_hex20(size, cells));
}

/// Prescribes a displacement field on the whole boundary.
template <Element E, class Field>
Scene prescribe_boundary(const Mesh<E>& mesh, Field field) {
  Scene scene;
  for (NodeId i : nodes_of(extract_boundary<E>(mesh))) {
    const Vector3 u = field(mesh.position(i));
    scene.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  return scene;
}

/// Largest difference between a model's nodal displacements and a field, over the largest displacement.
template <class Model, Element E, class Field>
double worst_error(const Model& model, const Mesh<E>& mesh, Field field) {
  double worst = 0.0;
  for (Index i = 0; i < mesh.node_count(); ++i)
    worst = std::max(worst, largest(model.displacement().template segment<3>(3 * i) - field(mesh.position(i))));
  return worst / largest(model.displacement());
}

/// Moves all nodes by up to `amount`. Edges of quadratic elements stay straight if asked.
template <Element E>
Mesh<E> shaken(Mesh<E> mesh, double amount, bool straight) {
  testing::Random random(61);
  for (Vector3& x : mesh.positions) x += random.vector<3>(-amount, amount);
  if constexpr (QuadraticElement<E>)
    if (straight)
      for (const auto& nodes : mesh.elements)
        for (std::size_t i = 0; i < E::edges.size(); ++i) {
          const auto at = [&](int a) -> Vector3& {
            return mesh.positions[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])];
          };
          at(E::Linear::nodes + static_cast<int>(i)) = 0.5 * (at(E::edges[i][0]) + at(E::edges[i][1]));
        }
  return mesh;
}

/// An affine field on a mesh in which all nodes are moved, those on the boundary too. Edges are curved unless
/// `straight`.
template <Element E>
void check_affine_patch(bool straight) {
  testing::Random random(47);
  Matrix3 a;
  for (int i = 0; i < 3; ++i) a.col(i) = random.vector<3>(-0.1, 0.1);
  for (double far : {0.0, 100.0}) {
    Mesh<E> mesh = shaken(box_of<E>({0.1, 0.08, 0.06}, {3, 2, 2}), 0.0015, straight);
    for (Vector3& x : mesh.positions) x += far * Vector3(1.0, -0.7, 0.3);
    const Vector3 shift(0.02, -0.03, 0.05), centre = mesh.position(0);
    const auto field = [&](const Vector3& x) -> Vector3 { return shift + a * (x - centre); };
    for (double nu : {0.3, 0.49}) {
      const StaticModel<E> model(mesh, prescribe_boundary(mesh, field), LinearElastic{5e3, nu, 1000.0});
      CHECK(worst_error(model, mesh, field) <= 1e-12 * (1.0 + far));
    }
  }
}

/// Force on the inner nodes under an affine field, over the largest on any node: rounding, if the rule integrates the
/// gradients of curved elements exactly.
template <Element E>
double force_inside(const Mesh<E>& mesh) {
  Matrix3 a;
  a << 0.01, 0.02, -0.01, 0.0, -0.02, 0.03, 0.01, 0.0, 0.02;
  VectorX u(3 * mesh.node_count()), f(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) u.template segment<3>(3 * i) = a * mesh.position(i);
  assemble_stiffness<E>(body_of(mesh, {liver}), {}).apply(u, f);
  const double most = largest(f);
  for (NodeId i : nodes_of(extract_boundary<E>(mesh))) f.template segment<3>(3 * Index{i}).setZero();
  return largest(f) / most;
}

/// The tractions of a constant stress on all sides of a box with distorted interior; six dofs are constrained.
template <Element E>
void check_traction_patch(bool straight) {
  const Vector3 size(0.1, 0.08, 0.06);
  const Mesh<E> flat = box_of<E>(size, {3, 2, 2});
  Mesh<E> mesh = shaken(flat, 0.0015, straight);
  for (NodeId i : nodes_of(extract_boundary<E>(flat)))
    mesh.positions[static_cast<std::size_t>(i)] = flat.position(Index{i});
  mesh = shaken(mesh, 0.0, straight);
  Matrix3 h;  // upper triangular: the six dofs below do not move
  h << 0.01, 0.004, -0.003, 0.0, -0.02, 0.005, 0.0, 0.0, 0.015;
  const Matrix3 stress = voigt::stress_tensor(liver.elasticity() * voigt::strain_vector(0.5 * (h + h.transpose())));
  Scene scene;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      scene.traction(std::string(1, "xyz"[axis]) + "01"[side], (side == 1 ? 1.0 : -1.0) * stress.col(axis));
  const auto node_at = [&](const Vector3& p) {
    NodeId best = 0;
    for (NodeId i = 0; i < mesh.node_count(); ++i)
      if ((mesh.position(i) - p).norm() < (mesh.position(best) - p).norm()) best = i;
    return std::vector<NodeId>{best};
  };
  scene.prescribe(node_at({0, 0, 0}), {0.0, 0.0, 0.0})
      .prescribe(node_at({0.1, 0, 0}), {std::nullopt, 0.0, 0.0})
      .prescribe(node_at({0, 0.08, 0}), {std::nullopt, std::nullopt, 0.0});
  const StaticModel<E> model(mesh, scene, liver);
  CHECK(worst_error(model, mesh, [&](const Vector3& x) -> Vector3 { return h * x; }) <= 1e-11);
  CHECK(largest(model.reactions()) <= 1e-11 * largest(stress) * 0.1 * 0.08);
}

/// A quadratic field under its body force, on sheared elements with straight edges: elements of second order are exact.
template <Element E>
void check_quadratic_patch() {
  Mesh<E> mesh = box_of<E>({0.1, 0.08, 0.06}, {2, 2, 2});
  Matrix3 shear;
  shear << 1.0, 0.2, -0.1, 0.0, 1.1, 0.3, 0.1, 0.0, 0.9;
  for (Vector3& x : mesh.positions) x = shear * x;
  testing::Random random(59);
  std::array<Matrix3, 3> q;  // u_i = x . Q_i x
  for (Matrix3& matrix : q) {
    for (int i = 0; i < 3; ++i) matrix.col(i) = random.vector<3>(-1.0, 1.0);
    matrix = Matrix3(0.5 * (matrix + matrix.transpose()));
  }
  const auto field = [&](const Vector3& x) { return Vector3(x.dot(q[0] * x), x.dot(q[1] * x), x.dot(q[2] * x)); };
  Vector3 laplacian, gradient_of_divergence = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    laplacian[static_cast<int>(i)] = 2.0 * q[i].trace();
    gradient_of_divergence += 2.0 * q[i].col(static_cast<int>(i));
  }
  const double lambda = liver.lame_lambda(), mu = liver.shear_modulus();
  Scene scene = prescribe_boundary(mesh, field);
  scene.body_load(everywhere, -(mu * laplacian + (lambda + mu) * gradient_of_divergence));
  const StaticModel<E> model(mesh, scene, liver);
  CHECK(worst_error(model, mesh, field) <= 1e-11);
}

/// Root mean square error of the displacement of u = (sin pi x sin pi y sin pi z) a on a unit cube of n^3 cells.
template <Element E>
double wave_error(int n) {
  constexpr double pi = std::numbers::pi;
  const Vector3 a(1.0, -0.5, 0.7);
  const LinearElastic m{1.0, 0.3, 1.0};
  const auto wave = [&](const Vector3& x) -> Vector3 { return (pi * x).array().sin().prod() * a; };
  const auto force = [&](const Vector3& x) -> Vector3 {  // -div sigma
    const Vector3 s = (pi * x).array().sin(), c = (pi * x).array().cos();
    Matrix3 hessian;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) hessian(i, j) = i == j ? -pi * pi * s.prod() : pi * pi * c[i] * c[j] * s[3 - i - j];
    return -(m.shear_modulus() * hessian.trace() * a + (m.lame_lambda() + m.shear_modulus()) * hessian * a);
  };
  const Mesh<E> mesh = box_of<E>({1, 1, 1}, {n, n, n});
  std::vector<Vector3> load(mesh.positions.size(), Vector3::Zero());
  const auto each_point = [&](auto visit) {  // position, weight, functions and nodes of every mass point
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const ElementNodes<E> x = element_nodes<E>(mesh, e);
      for (const auto& point : E::MassQuadrature::points) {
        const Vector3 xi = detail::reference_point(point);
        const auto shape = E::shape(xi);
        visit(Vector3(x.transpose() * shape), detail::point_geometry<E>(x, xi, point.weight).volume, shape,
              mesh.elements[static_cast<std::size_t>(e)]);
      }
    }
  };
  each_point([&](const Vector3& x, double weight, const auto& shape, const auto& nodes) {
    for (int b = 0; b < E::nodes; ++b)
      load[static_cast<std::size_t>(nodes[static_cast<std::size_t>(b)])] += weight * shape[b] * force(x);
  });
  Scene scene = Scene().fix("surface");
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    scene.point_load(std::vector<NodeId>{i}, load[static_cast<std::size_t>(i)]);
  const StaticModel<E> model(mesh, scene, m);
  double square = 0.0;
  each_point([&](const Vector3& x, double weight, const auto& shape, const auto& nodes) {
    Vector3 u = Vector3::Zero();
    for (int b = 0; b < E::nodes; ++b)
      u += shape[b] * model.displacement().template segment<3>(3 * Index{nodes[static_cast<std::size_t>(b)]});
    square += weight * (u - wave(x)).squaredNorm();
  });
  return std::sqrt(square);
}

/// The error falls with the power `order` + 1 of the mesh size.
template <Element E>
void check_convergence(int coarse, int fine) {
  const double before = wave_error<E>(coarse), after = wave_error<E>(fine);
  const double order = std::log(before / after) / std::log(static_cast<double>(fine) / coarse);
  INFO(before << ' ' << after << " order " << order);
  CHECK(order > E::order + 0.75);
  CHECK(order < E::order + 1.4);
  CHECK(after < 0.1);
}

}  // namespace test
