// Position-based constraints, used in games where springs do not preserve volume.
#include <palpate/assembly/body.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "particles.hpp"

namespace tradeoff {
namespace {

/// XPBD (Macklin, Mueller and Chentanez 2016) in small steps of one sweep each (Macklin et al. 2019), with the two
/// constraints of stable neo-Hookean tetrahedra (Macklin and Mueller 2021), element by element: sqrt(tr F^T F) with
/// compliance 1/(mu V), and det F - 1 - mu/lambda with compliance 1/(lambda V); lambda is Lame's plus mu, so that E and
/// nu are the constants at small strain.
struct PositionBased {
  struct Element {
    std::array<std::size_t, 4> nodes;
    Eigen::Matrix<double, 4, 3> gradient;
    double volume, mu, lambda;
  };
  Particles particles;
  std::vector<Element> elements;

  PositionBased(const Bench& bench, const Mesh<Tet4>& mesh) : particles(bench, mesh) {
    const auto materials = detail::materials_by_region(mesh, bench.scene.materials);
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const auto g = detail::constant_geometry<Tet4>(mesh, e);
      const LinearElastic& material = materials[static_cast<std::size_t>(mesh.region(e))];
      Element element{
          {}, g.gradient, g.volume, material.shear_modulus(), material.lame_lambda() + material.shear_modulus()};
      for (int a = 0; a < 4; ++a)
        element.nodes[static_cast<std::size_t>(a)] = static_cast<std::size_t>(mesh.element_node(e, a));
      elements.push_back(element);
    }
  }
  Matrix3 deformation(const Element& e) const {
    Matrix3 f = Matrix3::Zero();
    for (int a = 0; a < 4; ++a) f += particles.place[e.nodes[static_cast<std::size_t>(a)]] * e.gradient.row(a);
    return f;
  }
  static Matrix3 cofactor(const Matrix3& f) {
    Matrix3 c;
    c.col(0) = f.col(1).cross(f.col(2));
    c.col(1) = f.col(2).cross(f.col(0));
    c.col(2) = f.col(0).cross(f.col(1));
    return c;
  }
  /// Solves both constraints simultaneously: solved in sequence they would make an element at rest oscillate.
  void solve(const Element& e, double dt) {
    const Matrix3 f = deformation(e), c = cofactor(f);
    const double length = f.norm(), volume = f.col(0).dot(c.col(0));
    const Eigen::Matrix<double, 3, 4> shape = f / length * e.gradient.transpose(), size = c * e.gradient.transpose();
    Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
    a.diagonal() << 1.0 / (e.mu * e.volume * dt * dt), 1.0 / (e.lambda * e.volume * dt * dt);
    for (int k = 0; k < 4; ++k) {
      const double w = particles.inverse_mass[e.nodes[static_cast<std::size_t>(k)]];
      a(0, 0) += w * shape.col(k).squaredNorm();
      a(1, 1) += w * size.col(k).squaredNorm();
      a(0, 1) += w * shape.col(k).dot(size.col(k));
    }
    a(1, 0) = a(0, 1);
    const Vector2 multiplier = -a.inverse() * Vector2(length, volume - 1.0 - e.mu / e.lambda);
    for (int k = 0; k < 4; ++k) {
      const std::size_t i = e.nodes[static_cast<std::size_t>(k)];
      particles.place[i] += particles.inverse_mass[i] * (multiplier[0] * shape.col(k) + multiplier[1] * size.col(k));
    }
  }
  void step(double dt, std::span<const Vector3> centres, std::vector<Vector3>& forces) {
    particles.predict(dt);
    for (const Element& e : elements) solve(e, dt);
    particles.push_out(centres, dt, forces);
    particles.find_velocity(dt);
  }
  /// mu/2 tr F^T F + lambda/2 (J - 1 - mu/lambda)^2, minus the energy at rest.
  double energy() const {
    double sum = 0.0;
    for (const Element& e : elements) {
      const Matrix3 f = deformation(e);
      const double j = f.determinant() - 1.0 - e.mu / e.lambda, rest = e.mu / e.lambda;
      sum += e.volume * (0.5 * e.mu * (f.squaredNorm() - 3.0) + 0.5 * e.lambda * (j * j - rest * rest));
    }
    return sum;
  }
  /// Computed from the derivative of the energy, which equals the multipliers when a step has converged.
  Vector3 support_reaction() const {
    Vector3 sum = Vector3::Zero();
    for (const Element& e : elements) {
      const Matrix3 f = deformation(e), c = cofactor(f);
      const Matrix3 stress = e.mu * f + e.lambda * (f.col(0).dot(c.col(0)) - 1.0 - e.mu / e.lambda) * c;
      for (int a = 0; a < 4; ++a)
        if (particles.inverse_mass[e.nodes[static_cast<std::size_t>(a)]] == 0.0)
          sum += e.volume * stress * e.gradient.row(a).transpose();
    }
    return sum;
  }
};

}  // namespace

void add_position_based(const Bench& bench, std::vector<Entry>& entries) {
  for (const std::string& mesh : meshes_for_node_contact(bench))
    for (const int steps : {1, 5, 20}) {
      if (mesh != "given" && steps != 5 && !bench.full) continue;
      Entry entry{
          baseline(mesh, "XPBD", "neo-Hookean constraints", std::to_string(steps) + " substeps of one sweep", 0.05)};
      entry.make = [&bench, mesh, steps] {
        return std::make_unique<ParticleContender<PositionBased>>(bench, PositionBased(bench, bench.mesh(mesh)), steps);
      };
      entries.push_back(entry);
    }
}

}  // namespace tradeoff
