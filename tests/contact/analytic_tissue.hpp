// A tissue with a known solution: independent springs, all of them on one common spring.
#pragma once

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/contact_problem.hpp>

#include <vector>

namespace test {

using namespace palpate;

/// Vertices of a plane grid at z = 0, normal +z. Each moves with `own` [m/N] under its own force and all move with
/// `common` [m/N] under the sum of all forces, the same in all directions. The force of vertex x on a sphere of radius
/// R at p is then max(0, R - |p - x|) / own along p - x, after the common displacement has been subtracted from p.
class AnalyticTissue : public StillTissue {
 public:
  AnalyticTissue(int cells, double size, double own, double common = 0.0) : own_(own), common_(common) {
    std::vector<Vector3> positions;
    std::vector<Triangle> triangles;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        positions.emplace_back(size * (static_cast<double>(i) / cells - 0.5),
                               size * (static_cast<double>(j) / cells - 0.5), 0.0);
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const int a = i + (cells + 1) * j, b = a + 1, c = a + cells + 1, d = c + 1;
        triangles.push_back({a, b, d});
        triangles.push_back({a, d, c});
      }
    surface_ = ContactSurface(std::move(positions), std::move(triangles));
  }

  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept {
    ++compliance_calls;
    return (common_ + (i == j ? own_ : 0.0)) * Matrix3::Identity();
  }
  mutable long compliance_calls = 0;  ///< measures the work of a tick
  double compliance_bound(int) const noexcept { return own_ + common_; }
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_floor() const noexcept { return 1e-12; }
  const Eigen::Isometry3d& to_world() const noexcept { return pose_; }

  double own() const noexcept { return own_; }
  double common() const noexcept { return common_; }

  /// Force on a sphere whose centre is p relative to the common displacement.
  Vector3 spring_force(const Vector3& p, double radius) const {
    Vector3 f = Vector3::Zero();
    for (const Vector3& x : surface_.positions()) {
      const double distance = (p - x).norm();
      if (distance < radius) f += (radius - distance) / own_ * (p - x).normalized();
    }
    return f;
  }
  /// Force on one sphere whose device is at `target`: p = target + softness * F(p), by damped iteration.
  Vector3 exact_force(const Vector3& target, double radius, double coupling_compliance) const {
    Vector3 f = Vector3::Zero();
    const double softness = coupling_compliance + common_;
    // The stiffness of the springs is at most their number in reach over `own`; the step is chosen to contract.
    const double step = 1.0 / (1.0 + 60.0 * softness / own_);
    for (int i = 0; i < 200'000; ++i) {
      const Vector3 next = spring_force(target + softness * f, radius);
      const Vector3 change = step * (next - f);
      f += change;
      if (change.norm() <= 1e-15 * f.norm()) break;
    }
    return f;
  }
  /// Energy stored when a rigidly coupled sphere is at p (common = 0).
  double energy(const Vector3& p, double radius) const {
    double e = 0.0;
    for (const Vector3& x : surface_.positions()) {
      const double depth = std::max(0.0, radius - (p - x).norm());
      e += 0.5 * depth * depth / own_;
    }
    return e;
  }

 private:
  ContactSurface surface_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  double own_, common_;
};
static_assert(TissueModel<AnalyticTissue>);

/// Positions of all vertices under forces.
template <TissueModel Tissue>
std::vector<Vector3> deformed_surface(const Tissue& tissue, std::span<const VertexForce> forces) {
  std::vector<Vector3> x = tissue.contact_surface().positions();
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const VertexForce& f : forces)
      x[i] += tissue.compliance(static_cast<int>(i), f.vertex) * f.force.in_model_axes();
  return x;
}

/// Smallest gap between a sphere at `proxy` (model frame) and any contact point of the deformed surface, including
/// points that face away from the sphere.
template <TissueModel Tissue>
double smallest_gap(const Tissue& tissue, const detail::ContactSamples& samples, std::span<const VertexForce> forces,
                    const Vector3& proxy, double radius) {
  const std::vector<Vector3> x = deformed_surface(tissue, forces);
  double smallest = infinity;
  for (int i = 0; i < samples.count(); ++i) {
    const detail::ContactSample& s = samples[i];
    Vector3 q = Vector3::Zero();
    for (std::size_t a = 0; a < 3; ++a) q += s.weights[a] * x[static_cast<std::size_t>(s.vertices[a])];
    smallest = std::min(smallest, (proxy - q).norm() - radius);
  }
  return smallest;
}

}  // namespace test
