#include "reference.hpp"

#include <palpate/element/tet10.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/promote.hpp>

#include "../common/timing.hpp"
#include "pressed_forces.hpp"

namespace tradeoff {
namespace {

RegionMaterials<NeoHookean> large_strain(const RegionMaterials<LinearElastic>& materials) {
  RegionMaterials<NeoHookean> laws;
  for (const auto& [region, m] : materials) laws.push_back({region, {m.youngs_modulus, m.poisson_ratio, m.density}});
  return laws;
}

/// Of a node [N/m]: a ball sinks in by some thousandths of the small depth.
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

template <class E>
Reference solve(const PressScene& scene, Mesh<E> mesh) {
  Reference r;
  const auto boundary = boundary_triangles(scene.mesh);
  const std::vector<NodeId> nodes = mesh.find_group(near_group)->nodes;
  r.nodes = mesh.node_count();
  r.curve.push_back({0.0, std::vector<Vector3>(scene.balls.size(), Vector3::Zero())});
  r.seconds = bench::seconds_of([&] {
    PressedEquilibrium body(
        make_held_body(make_hyperelastic_body(std::move(mesh), large_strain(scene.materials)), scene.scene(near_group)),
        nodes, scene.radius, contact_stiffness(scene));
    for (const double depth : depths(scene)) {
      body.move_to(scene.centres(depth));
      r.curve.push_back({depth, body.forces_on_balls()});
      Vector3 sum = body.support();
      double largest = 0.0;
      for (const Vector3& f : r.curve.back().force) {
        sum -= f;
        largest = std::max(largest, f.norm());
      }
      if (!(sum.norm() < 1e-4 * largest) || !(body.largest_depth() < 2e-2 * scene.small))
        raise(SetupErrorKind::not_converged, "the reference is no equilibrium at a depth of " + number(depth) +
                                                 " m: supports are off by " + number(sum.norm() / largest) +
                                                 ", the ball sinks in by " + number(body.largest_depth()) + " m");
      const VectorX u = body.displacement().head(3 * scene.mesh.node_count());
      if (depth == scene.small) r.displacement_small = u;
      r.displacement_large = u;
    }
  });
  r.volume_small = volume_of(scene.mesh, boundary, r.displacement_small);
  r.volume_large = volume_of(scene.mesh, boundary, r.displacement_large);
  return r;
}

double apart(const Reference& a, const Reference& b, double depth) {
  return (a.force(0, depth) - b.force(0, depth)).norm() / a.force(0, depth).norm();
}

}  // namespace

Vector3 Reference::force(std::size_t ball, double depth) const {
  if (depth <= 0.0) return Vector3::Zero();
  std::size_t i = 1;
  while (i + 1 < curve.size() && curve[i].depth < depth) ++i;
  const Point &a = curve[i - 1], &b = curve[i];
  if (a.depth == 0.0) return std::pow(depth / b.depth, 1.5) * b.force[ball];
  // F / d^1.5 is nearly straight in d, and that is interpolated
  const double t = (depth - a.depth) / (b.depth - a.depth);
  return std::pow(depth, 1.5) *
         ((1.0 - t) * std::pow(a.depth, -1.5) * a.force[ball] + t * std::pow(b.depth, -1.5) * b.force[ball]);
}

Reference make_reference(const PressScene& scene, double edge) {
  const Reference coarse = solve(scene, promote<Tet10>(refine_near(scene, 2.0 * edge * scene.radius)));
  Reference fine = solve(scene, promote<Tet10>(refine_near(scene, edge * scene.radius)));
  fine.mesh_error_small = apart(fine, coarse, scene.small);
  fine.mesh_error_large = apart(fine, coarse, scene.large);
  fine.seconds += coarse.seconds;
  return fine;
}

Stiffening measure_stiffening(const PressScene& scene) {
  // Somewhere else on the touchable surface: a curve that was measured where it is used would prove nothing.
  const std::vector<NodeId>& wide = scene.mesh.find_group(wide_group)->nodes;
  PressScene other = scene;
  const Vector3 from = scene.balls.front().point, wanted = from + 2.0 * scene.radius * Vector3::UnitX();
  const NodeId node =
      *std::ranges::min_element(wide, {}, [&](NodeId i) { return (scene.mesh.position(i) - wanted).squaredNorm(); });
  other.balls = {ball_along_normal(scene.mesh, scene.mesh.position(node), scene.radius)};
  const double k = contact_stiffness(scene);
  PressedEquilibrium real(
      make_held_body(make_hyperelastic_body(scene.mesh, large_strain(scene.materials)), scene.scene(near_group)), wide,
      scene.radius, k),
      linear(make_deformable_body(make_body(scene.mesh, scene.materials), scene.scene(near_group)), wide, scene.radius,
             k);
  Stiffening s;
  for (const double depth : depths(other)) {
    real.move_to(other.centres(depth));
    linear.move_to(other.centres(depth));
    s.depth.push_back(depth);
    s.ratio.push_back(real.forces_on_balls().front().norm() / linear.forces_on_balls().front().norm());
  }
  return s;
}

}  // namespace tradeoff
