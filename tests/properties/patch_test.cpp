// Manufactured solutions: affine ones exactly, smooth ones with the order of the element.
#include "model/any_model.hpp"
#include "model/reference.hpp"

#include <numbers>

using namespace test;

namespace {

/// Prescribes a displacement field on the whole boundary.
template <class Field>
Scene prescribe_boundary(Scene scene, const Mesh<Tet4>& mesh, Field field) {
  for (NodeId i : nodes_of(extract_boundary<Tet4>(mesh))) {
    const Vector3 u = field(mesh.position(i));
    scene.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  return scene;
}

constexpr double pi = std::numbers::pi;

/// u = (sin pi x sin pi y sin pi z) a, and the body force that belongs to it.
struct Wave {
  Vector3 a{1.0, -0.5, 0.7};
  Vector3 displacement(const Vector3& x) const {
    return std::sin(pi * x[0]) * std::sin(pi * x[1]) * std::sin(pi * x[2]) * a;
  }
  /// -div sigma = -(mu lap u + (lambda + mu) grad div u).
  Vector3 force(const Vector3& x, const LinearElastic& m) const {
    const Vector3 s = (pi * x).array().sin(), c = (pi * x).array().cos();
    Matrix3 hessian;  // of the scalar wave
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int k = 3 - i - j;
        hessian(i, j) = i == j ? -pi * pi * s.prod() : pi * pi * c[i] * c[j] * s[k];
      }
    const double lambda = m.lame_lambda(), mu = m.shear_modulus();
    return -(mu * hessian.trace() * a + (lambda + mu) * hessian * a);
  }
};

/// Largest nodal error on a unit cube of n^3 cells.
double wave_error(int n, BoxSplit split) {
  const Wave wave;
  const LinearElastic m{1.0, 0.3, 1.0};
  const Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {n, n, n}, split);
  Scene scene = Scene().fix("surface");
  const VectorX volume = nodal_mass(body_of(mesh, {m}));
  const EssentialConditions c = conditions_of(mesh, scene);
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if (!c.is_constrained(3 * Index{i}))
      scene.point_load(std::vector<NodeId>{i}, volume[i] * wave.force(mesh.position(i), m));
  const auto model = make_model(PolicyName::sparse_cholesky, mesh, scene, m);
  double worst = 0.0;
  for (Index i = 0; i < mesh.node_count(); ++i)
    worst = std::max(worst, (model->displacement().segment<3>(3 * i) - wave.displacement(mesh.position(i))).norm());
  return worst;
}

}  // namespace

TEST_CASE("an affine field is reproduced on a distorted mesh, here and far away", "[property][patch]") {
  testing::Random random(47);
  for (BoxSplit split : {BoxSplit::five_mirrored, BoxSplit::six})
    for (double far : {0.0, 100.0}) {
      Mesh<Tet4> mesh = jittered(box_tet4({0.1, 0.08, 0.06}, {3, 3, 3}, split), 0.004, {0.1, 0.08, 0.06});
      for (Vector3& x : mesh.positions) x += far * Vector3(1.0, -0.7, 0.3);
      Matrix3 a;
      for (int i = 0; i < 3; ++i) a.col(i) = random.vector<3>(-0.1, 0.1);
      const Vector3 shift(0.02, -0.03, 0.05), centre = mesh.position(0);
      const auto field = [&](const Vector3& x) -> Vector3 { return shift + a * (x - centre); };
      for (PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::condensed_inverse}) {
        Scene scene = prescribe_boundary(Scene(), mesh, field);
        if (policy == PolicyName::condensed_inverse) scene.touch("z1");
        for (double nu : {0.3, 0.49}) {
          const auto model = make_model(policy, mesh, scene, {5e3, nu, 1000.0});
          double worst = 0.0;
          for (Index i = 0; i < mesh.node_count(); ++i)
            worst = std::max(worst, largest(model->displacement().segment<3>(3 * i) - field(mesh.position(i))));
          CHECK(worst <= 1e-12 * largest(model->displacement()));
        }
      }
    }
}

TEST_CASE("an affine field under its tractions", "[property][patch]") {
  // All dofs but six are free: the tractions are those of a constant stress.
  const Mesh<Tet4> mesh = jittered(box_tet4({0.1, 0.08, 0.06}, {3, 3, 3}), 0.004, {0.1, 0.08, 0.06});
  Matrix3 h;  // upper triangular: the six dofs below do not move
  h << 0.01, 0.004, -0.003, 0.0, -0.02, 0.005, 0.0, 0.0, 0.015;
  const Vector6 strain = voigt::strain_vector(0.5 * (h + h.transpose()));
  const Matrix3 stress = voigt::stress_tensor(liver.elasticity() * strain);
  Scene scene;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      scene.traction(std::string(1, "xyz"[axis]) + "01"[side], (side == 1 ? 1.0 : -1.0) * stress.col(axis));
  scene.prescribe(std::vector<NodeId>{0}, {0.0, 0.0, 0.0})
      .prescribe(std::vector<NodeId>{3}, {std::nullopt, 0.0, 0.0})             // on the x axis
      .prescribe(std::vector<NodeId>{12}, {std::nullopt, std::nullopt, 0.0});  // on the y axis
  const auto model = make_model(PolicyName::sparse_cholesky, mesh, scene, liver);
  double worst = 0.0;
  for (Index i = 0; i < mesh.node_count(); ++i)
    worst = std::max(worst, largest(model->displacement().segment<3>(3 * i) - h * mesh.position(i)));
  CHECK(worst <= 1e-12 * largest(model->displacement()));
  CHECK(largest(model->reactions()) <= 1e-12 * largest(stress) * 0.1 * 0.08);
}

TEST_CASE("free swelling has no stress", "[property][patch]") {
  Vector6 swelling = Vector6::Zero();
  swelling.head<3>().setConstant(0.01);
  const Scene scene = Scene()
                          .initial_strain(everywhere, swelling)
                          .prescribe(std::vector<NodeId>{0}, {0.0, 0.0, 0.0})
                          .prescribe(std::vector<NodeId>{3}, {std::nullopt, 0.0, 0.0})
                          .prescribe(std::vector<NodeId>{8}, {std::nullopt, std::nullopt, 0.0});
  const auto model = make_model(PolicyName::sparse_cholesky, brick(), scene, liver);
  for (Index i = 0; i < 36; ++i)
    CHECK(largest(model->displacement().segment<3>(3 * i) - 0.01 * brick().position(i)) <= 1e-14);
  CHECK(model->strain_energy() <= 1e-24 * liver.youngs_modulus);
}

TEST_CASE("a smooth field converges with the square of the mesh size", "[property][mms]") {
  for (BoxSplit split : {BoxSplit::five_mirrored, BoxSplit::six}) {
    const double coarse = wave_error(4, split), fine = wave_error(8, split);
    INFO(coarse << ' ' << fine);
    const double order = std::log2(coarse / fine);
    CHECK(order > 1.6);
    CHECK(order < 2.6);
    CHECK(fine < 0.1);
  }
}
