// A block pressed and dragged at large strain, for several methods.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/mesh/generators.hpp>

#include "../common/bodies.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace large_strain {

using namespace palpate;

inline constexpr double step_length = 0.016;  // [s]
inline constexpr double duration = 2.24;      // [s]

/// A cube of 0.1 m in n x n x n cells, fixed at the bottom. A square of 0.05 m in the middle of its top is pressed 20
/// mm down within a second, dragged 15 mm sideways within another second, then kept there. `n` is a multiple of 4, so
/// that the square is the same for all n.
struct PressedBlock {
  Mesh<Tet4> mesh;
  std::vector<NodeId> bottom, square;

  explicit PressedBlock(int n)
      : mesh(box_tet4(Vector3(0.1, 0.1, 0.1), {n, n, n}, BoxSplit::six)),
        bottom(bench::nodes_where(mesh, on_bottom)),
        square(bench::nodes_where(mesh, in_square)) {}
  static bool on_bottom(const Vector3& p) { return p.z() < 1e-9; }
  static bool in_square(const Vector3& p) {
    return p.z() > 0.1 - 1e-9 && std::abs(p.x() - 0.05) < 0.025 + 1e-6 && std::abs(p.y() - 0.05) < 0.025 + 1e-6;
  }
  /// Displacement of the square at a time [m].
  static Vector3 path(double time) {
    const auto smooth = [](double t) { return 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(t, 0.0, 1.0)); };
    return {0.015 * smooth(time - 1.0), 0.0, -0.02 * smooth(time)};
  }
};

/// A method that moves the block by steps of `step_length`, with the square at a prescribed displacement.
class Method {
 public:
  virtual ~Method() = default;
  virtual void step(const Vector3& square) = 0;
  /// Force that displaces the square [N]: the elastic forces on its nodes, by the method's own element and law.
  virtual Vector3 force() = 0;
};

/// Factory of a method for a block, and how to show it. Methods with one name are points of one curve.
struct Entry {
  std::string name, colour;
  std::function<std::unique_ptr<Method>(const PressedBlock&)> make;
  int largest = 16;  ///< n
};

/// Elastic forces on nodes of a mesh of Tet4 at node positions `place(node)`; `stress` gives the first Piola-Kirchhoff
/// stress of a deformation gradient.
template <class Place, class Stress>
Vector3 elastic_force(const Mesh<Tet4>& mesh, const std::vector<NodeId>& on, Place&& place, Stress&& stress) {
  std::vector<char> counted(mesh.positions.size(), 0);
  for (const NodeId i : on) counted[static_cast<std::size_t>(i)] = 1;
  Vector3 sum = Vector3::Zero();
  for (Index e = 0; e < mesh.element_count(); ++e) {
    Vector3 gradient = Vector3::Zero();
    const auto g = detail::constant_geometry<Tet4>(mesh, e);
    for (int a = 0; a < 4; ++a)
      if (counted[static_cast<std::size_t>(mesh.element_node(e, a))] != 0) gradient += g.gradient.row(a).transpose();
    if (gradient.isZero(0.0)) continue;
    Matrix3 f = Matrix3::Zero();
    for (int a = 0; a < 4; ++a) f += place(mesh.element_node(e, a)) * g.gradient.row(a);
    sum += g.volume * stress(f) * gradient;
  }
  return sum;
}

/// The law of the comparison, as in palpate::NeoHookean.
struct StableNeoHookean {
  double mu = bench::tissue.shear_modulus(), lambda = bench::tissue.lame_lambda() + mu;

  static Matrix3 cofactor(const Matrix3& f) {
    Matrix3 c;
    c << f.col(1).cross(f.col(2)), f.col(2).cross(f.col(0)), f.col(0).cross(f.col(1));
    return c;
  }
  double energy(const Matrix3& f) const {
    const double j = f.determinant() - 1.0;
    return 0.5 * mu * (f.squaredNorm() - 3.0) - mu * j + 0.5 * lambda * j * j;
  }
  /// Derivative of the energy with respect to det F.
  double pressure(const Matrix3& f) const { return lambda * (f.determinant() - 1.0) - mu; }
  Matrix3 operator()(const Matrix3& f) const { return mu * f + pressure(f) * cofactor(f); }
};

/// First Piola-Kirchhoff stress of co-rotated linear elasticity, tr(R^T F - I) as its volume change.
Matrix3 corotated_stress(const Matrix3& f);

void add_palpate(std::vector<Entry>& entries);
void add_plain_eigen(std::vector<Entry>& entries);
void add_position_based(std::vector<Entry>& entries);
/// Where Bullet is installed.
void add_bullet(std::vector<Entry>& entries);

/// Forces at rest on the square at the times of the steps, every `every`th one [N]: Tet10, twice n of the finest block.
std::vector<Vector3> reference_forces(int n, int every);

}  // namespace large_strain
