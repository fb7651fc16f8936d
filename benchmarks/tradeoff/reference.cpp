#include "direct_reference.hpp"

#include <palpate/element/tet10.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/promote.hpp>

#include <Eigen/Geometry>

#include "../common/timing.hpp"
#include "linear_press.hpp"
#include "pressed_forces.hpp"

namespace tradeoff {
namespace {

RegionMaterials<NeoHookean> large_strain(const RegionMaterials<LinearElastic>& materials) {
  RegionMaterials<NeoHookean> converted;
  for (const auto& [region, m] : materials)
    converted.push_back({region, {m.youngs_modulus, m.poisson_ratio, m.density}});
  return converted;
}

/// Contact stiffness of a node [N/m]: a sphere penetrates by some thousandths of the small depth.
double contact_stiffness(const PressScene& scene) {
  double softest = infinity;
  for (const auto& region : scene.materials) softest = std::min(softest, region.second.youngs_modulus);
  return 60.0 * softest * scene.radius;
}

std::vector<double> depths(const PressScene& scene) {
  std::vector<double> d{0.5 * scene.small, scene.small};
  constexpr int more = 3;
  for (int i = 1; i <= more; ++i) d.push_back(scene.small + (scene.large - scene.small) * i / more);
  return d;
}

/// Fully converged equilibria at every depth, by Newton's method.
std::vector<Pressed> press(const PressScene& scene, DeformableBody body, const std::vector<NodeId>& nodes) {
  PressedEquilibrium equilibrium(std::move(body), nodes, scene.radius, contact_stiffness(scene));
  std::vector<Pressed> all;
  for (const double depth : depths(scene)) {
    equilibrium.move_to(scene.centres(depth));
    for (int i = 0; i < 4 && !(equilibrium.largest_depth() < 2e-2 * scene.small); ++i) {
      equilibrium.stiffen();
      equilibrium.move_to(scene.centres(depth));
    }
    all.push_back({equilibrium.forces_on_spheres(), equilibrium.displacement().head(3 * scene.mesh.node_count())});
    require_balance(all.back(), equilibrium.support(), depth);
    if (!(equilibrium.largest_depth() < 2e-2 * scene.small))
      raise(SetupErrorKind::not_converged,
            "the sphere of the reference penetrates by " + number(equilibrium.largest_depth()) + " m");
  }
  return all;
}

template <class E>
std::vector<Pressed> press_linear(const PressScene& scene, const Mesh<E>& mesh) {
  LinearPress<E> press(scene, mesh);
  std::vector<Pressed> all;
  for (const double depth : depths(scene)) all.push_back(press.at(depth));
  return all;
}

template <class E>
std::vector<Pressed> press_large_strain(const PressScene& scene, const Mesh<E>& mesh) {
  return press(
      scene,
      make_constrained_body(make_hyperelastic_body(mesh, large_strain(scene.materials)), scene.scene(near_group)),
      mesh.find_group(near_group)->nodes);
}

Reference reference_of(const PressScene& scene, const std::vector<Pressed>& all) {
  Reference r;
  r.curve.push_back({0.0, std::vector<Vector3>(scene.spheres.size(), Vector3::Zero())});
  const std::vector<double> at = depths(scene);
  for (std::size_t i = 0; i < at.size(); ++i) {
    r.curve.push_back({at[i], all[i].force});
    if (at[i] == scene.small) r.displacement_small = all[i].displacement;
    r.displacement_large = all[i].displacement;
  }
  const auto boundary = boundary_triangles(scene.mesh);
  r.volume_small = volume_of(scene.mesh, boundary, r.displacement_small);
  r.volume_large = volume_of(scene.mesh, boundary, r.displacement_large);
  return r;
}

/// The small strain solution of the fine mesh, corrected by the effect of large strain on a coarser mesh.
std::vector<Pressed> corrected(const PressScene& scene, std::vector<Pressed> fine) {
  const Mesh<Tet4> cheap = refine_near(scene, 0.3 * scene.radius);
  const auto curved = press_large_strain(scene, cheap), straight = press_linear(scene, cheap);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    for (std::size_t b = 0; b < fine[i].force.size(); ++b) {
      const Vector3 &from = straight[i].force[b], &to = curved[i].force[b];
      const double ratio = to.norm() / from.norm();
      fine[i].force[b] = ratio * (Eigen::Quaterniond::FromTwoVectors(from, to) * fine[i].force[b]);
    }
    fine[i].displacement += curved[i].displacement - straight[i].displacement;
  }
  return fine;
}

double relative_difference(const Reference& a, const Reference& b, double depth) {
  return (a.force(0, depth) - b.force(0, depth)).norm() / a.force(0, depth).norm();
}

Reference make(const PressScene& scene, double edge, bool direct) {
  Reference r, coarse;
  const double seconds = bench::seconds_of([&] {
    const Mesh<Tet10> mesh = promote<Tet10>(refine_near(scene, edge * scene.radius)),
                      half = promote<Tet10>(refine_near(scene, 2.0 * edge * scene.radius));
    const std::vector<Pressed> fine = press_linear(scene, mesh);
    r = reference_of(scene, fine);
    coarse = reference_of(scene, press_linear(scene, half));
    const double small = relative_difference(r, coarse, scene.small),
                 large = relative_difference(r, coarse, scene.large);
    r = reference_of(scene, direct ? press_large_strain(scene, mesh) : corrected(scene, fine));
    r.mesh_error_small = small;
    r.mesh_error_large = large;
    r.nodes = mesh.node_count();
  });
  r.seconds = seconds;
  return r;
}

}  // namespace

Vector3 Reference::force(std::size_t sphere, double depth) const {
  if (depth <= 0.0) return Vector3::Zero();
  std::size_t i = 2;  // the first point is at depth 0
  while (i + 1 < curve.size() && curve[i].depth < depth) ++i;
  const Point &a = curve[i - 1], &b = curve[i];
  const Vector3 &low = a.force[sphere], &high = b.force[sphere];
  // 1.5 for a half-space and 1 for bending: the length of the force divided by this power is the same at both points
  double power = std::log(high.norm() / low.norm()) / std::log(b.depth / a.depth);
  if (!std::isfinite(power)) power = 1.5;
  const double t = std::clamp((depth - a.depth) / (b.depth - a.depth), 0.0, 1.0);
  return std::pow(depth, power) * ((1.0 - t) * std::pow(a.depth, -power) * low + t * std::pow(b.depth, -power) * high);
}

Reference make_reference(const PressScene& scene, double edge) {
  return make(scene, edge, false);
}
Reference make_direct_reference(const PressScene& scene, double edge) {
  return make(scene, edge, true);
}

Stiffening measure_stiffening(const PressScene& scene) {
  // At another point of the touchable surface: a curve measured where it is used would not be a test.
  const std::vector<NodeId>& wide = scene.mesh.find_group(wide_group)->nodes;
  PressScene other = scene;
  const Vector3 from = scene.spheres.front().point, wanted = from + 2.0 * scene.radius * Vector3::UnitX();
  const NodeId node =
      *std::ranges::min_element(wide, {}, [&](NodeId i) { return (scene.mesh.position(i) - wanted).squaredNorm(); });
  other.spheres = {sphere_along_normal(scene.mesh, scene.mesh.position(node), scene.radius)};
  const double k = contact_stiffness(scene);
  PressedEquilibrium real(
      make_constrained_body(make_hyperelastic_body(scene.mesh, large_strain(scene.materials)), scene.scene(near_group)),
      wide, scene.radius, k),
      linear(make_deformable_body(make_body(scene.mesh, scene.materials), scene.scene(near_group)), wide, scene.radius,
             k);
  Stiffening s;
  for (const double depth : depths(other)) {
    real.move_to(other.centres(depth));
    linear.move_to(other.centres(depth));
    s.depth.push_back(depth);
    s.ratio.push_back(real.forces_on_spheres().front().norm() / linear.forces_on_spheres().front().norm());
  }
  return s;
}

}  // namespace tradeoff
