// Mass-spring systems, used in games and many simulators.
#include <palpate/assembly/body.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <map>

#include "particles.hpp"

namespace tradeoff {
namespace {

/// A spring along every edge of stiffness E * (sum of adjacent volumes) / length^2 (Van Gelder, Approximate simulation
/// of elastic membranes by triangulated spring meshes, 1998, in its form for tetrahedra). Semi-implicit Euler.
struct MassSpring {
  struct Spring {
    NodeId a, b;
    double length, stiffness;
  };
  Particles particles;
  std::vector<Spring> springs;

  MassSpring(const Bench& bench, const Mesh<Tet4>& mesh, double factor = 1.0) : particles(bench, mesh) {
    const auto materials = detail::materials_by_region(mesh, bench.scene.materials);
    std::map<std::pair<NodeId, NodeId>, double> stiffness;
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const double volume = detail::constant_geometry<Tet4>(mesh, e).volume,
                   modulus = materials[static_cast<std::size_t>(mesh.region(e))].youngs_modulus;
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
          stiffness[std::minmax(mesh.element_node(e, i), mesh.element_node(e, j))] += modulus * volume;
    }
    for (const auto& [edge, sum] : stiffness) {
      const double length = (mesh.position(edge.first) - mesh.position(edge.second)).norm();
      springs.push_back({edge.first, edge.second, length, factor * sum / (length * length)});
    }
  }
  /// Steps per millisecond required for stability, by Gershgorin's bound of the highest frequency.
  int steps() const {
    std::vector<double> sum(particles.rest.size(), 0.0);
    for (const Spring& s : springs)
      for (const NodeId i : {s.a, s.b}) sum[static_cast<std::size_t>(i)] += 2.0 * s.stiffness;
    double square = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) square = std::max(square, sum[i] * particles.inverse_mass[i]);
    return static_cast<int>(std::ceil(1e-3 * std::sqrt(square) / 2.0 / 0.8));
  }
  void pull() {
    std::ranges::fill(particles.force, Vector3::Zero());
    for (const Spring& s : springs) {
      const auto a = static_cast<std::size_t>(s.a), b = static_cast<std::size_t>(s.b);
      const Vector3 path = particles.place[b] - particles.place[a];
      const double length = path.norm();
      const Vector3 f = s.stiffness * (1.0 - s.length / length) * path;
      particles.force[a] += f;
      particles.force[b] -= f;
    }
  }
  void step(double dt, std::span<const Vector3> centres, std::vector<Vector3>& forces) {
    pull();
    particles.predict(dt);
    particles.push_out(centres, dt, forces);
    particles.find_velocity(dt);
  }
  double energy() const {
    double sum = 0.0;
    for (const Spring& s : springs) {
      const double longer =
          (particles.place[static_cast<std::size_t>(s.b)] - particles.place[static_cast<std::size_t>(s.a)]).norm() -
          s.length;
      sum += 0.5 * s.stiffness * longer * longer;
    }
    return sum;
  }
  Vector3 support_reaction() {
    pull();
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < particles.force.size(); ++i)
      if (particles.inverse_mass[i] == 0.0) sum -= particles.force[i];
    return sum;
  }
};

std::unique_ptr<Contender> make_springs(const Bench& bench, const Mesh<Tet4>& mesh, double factor = 1.0) {
  MassSpring body(bench, mesh, factor);
  const int steps = body.steps();
  return std::make_unique<ParticleContender<MassSpring>>(bench, std::move(body), steps);
}
/// Springs with stiffness tuned to the reference force at the small depth of this scene: their best case.
std::unique_ptr<Contender> make_tuned_springs(const Bench& bench, const Mesh<Tet4>& mesh) {
  const PressScene& scene = bench.scene;
  const double wanted = bench.reference.force(0, scene.small).norm();
  double factor = 1.0;
  for (int round = 0; round < 3; ++round) {  // spring forces are not exactly proportional to the factor
    const auto trial = make_springs(bench, mesh, factor);
    double force = 0.0;
    for (int i = 0; i < 600; ++i)
      force = trial->tick(scene.centres(std::min(1.0, i / 100.0) * scene.small)).front().norm();
    if (!(force > 0.01 * wanted))
      raise(SetupErrorKind::not_converged, "springs cannot be tuned: the sphere at the small depth meets no node");
    factor *= wanted / force;
  }
  return make_springs(bench, mesh, factor);
}

}  // namespace

void add_springs(const Bench& bench, std::vector<Entry>& entries) {
  for (const std::string& mesh : meshes_for_node_contact(bench)) {
    Entry springs{baseline(mesh, "mass-spring", "Van Gelder's stiffness", "semi-implicit Euler", 0.05)};
    springs.make = [&bench, mesh] { return make_springs(bench, bench.mesh(mesh)); };
    entries.push_back(springs);
    springs.description.kinematics = "stiffness tuned at the small depth";
    springs.make = [&bench, mesh] { return make_tuned_springs(bench, bench.mesh(mesh)); };
    entries.push_back(springs);
  }
}

}  // namespace tradeoff
